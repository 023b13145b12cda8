"""The frame of all commands: exit codes, errors of one line, interrupts, broken pipes."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from typing import Concatenate, ParamSpec

from tamp.errors import InputError
from tamp.system.progress import Progress
from tamp.system.terminal import spoken

BAD_INPUT, INTERRUPTED = 2, 130
"""Exit codes that all commands share; a SIGTERM's 143 is set by `tamp.system.guard`."""

P = ParamSpec("P")


def as_command(
    interrupted: str = "interrupted",
) -> Callable[[Callable[Concatenate[Progress, P], int]], Callable[P, int]]:
    """Frame a command's function: it returns an exit code, whatever happens in it.

    What is framed gets a `Progress` before its own arguments, silent until the command sets
    `quiet`; it has ended when an error is printed and when the function returns. An `InputError`
    is printed as one line and becomes 2, Ctrl-C becomes 130, and output that cannot be printed
    is as in `tamp.system.terminal.spoken`. After the help it is left by SystemExit.

    Args:
        interrupted: What is said after a Ctrl-C; nothing when it is empty.
    """

    def frame(work: Callable[Concatenate[Progress, P], int]) -> Callable[P, int]:
        @functools.wraps(work)
        def framed(*args: P.args, **kwargs: P.kwargs) -> int:
            left: list[SystemExit] = []

            @spoken
            def speaking(*args: P.args, **kwargs: P.kwargs) -> int:
                shown = Progress(quiet=True)
                try:
                    return work(shown, *args, **kwargs)
                except InputError as error:
                    shown.end()
                    sys.stderr.write(f"error: {error}\n")
                    return BAD_INPUT
                except KeyboardInterrupt:
                    shown.end()
                    if interrupted:
                        sys.stderr.write(f"{interrupted}\n")
                    return INTERRUPTED
                except SystemExit as end:
                    left.append(end)
                    raise
                finally:
                    shown.end()

            code = speaking(*args, **kwargs)
            if left:  # after the help
                raise SystemExit(code)
            return code

        return framed

    return frame
