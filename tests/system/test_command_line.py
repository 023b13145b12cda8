"""The frame of all commands."""

from __future__ import annotations

import sys

import pytest

from tamp.errors import InputError
from tamp.system.command_line import BAD_INPUT, INTERRUPTED, as_command
from tamp.system.progress import Progress

SAID = "error: no such thing\n"


@pytest.mark.parametrize(
    ("raised", "code", "said"),
    [
        (InputError("no such thing"), BAD_INPUT, SAID),
        (KeyboardInterrupt(), INTERRUPTED, "stopped\n"),
        (MemoryError(), 2, "error: there is not enough memory\n"),
        (OSError(28, "No space left on device"), 2, "error: No space left on device\n"),
    ],
)
def test_what_a_command_raises_is_one_line_and_a_code(
    raised: BaseException, code: int, said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    seen: list[Progress] = []

    @as_command(interrupted="stopped")
    def command(shown: Progress) -> int:
        seen.append(shown)
        shown.quiet = False
        shown.begin("working")
        raise raised

    assert command() == code
    assert capsys.readouterr().err == said
    assert [shown._stop for shown in seen] == [None]  # it speaks no more


def test_a_command_returns_its_code_and_begins_in_silence() -> None:
    @as_command()
    def command(shown: Progress, arguments: list[str], *, more: int) -> int:
        assert shown.quiet
        return len(arguments) + more

    assert command(["a", "b"], more=1) == 3


def test_a_command_without_a_word_for_ctrl_c(capsys: pytest.CaptureFixture[str]) -> None:
    @as_command(interrupted="")
    def command(shown: Progress) -> int:
        raise KeyboardInterrupt

    assert command() == INTERRUPTED
    assert capsys.readouterr().err == ""


def test_after_the_help_the_process_ends() -> None:
    @as_command()
    def command(shown: Progress) -> int:
        sys.exit(0)

    with pytest.raises(SystemExit) as ended:
        command()
    assert ended.value.code == 0
