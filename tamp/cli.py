"""tamp-solve: a domain and a problem in, a plan file out."""

from __future__ import annotations

import contextlib
import importlib
import importlib.util
import io
import math
import os
import shlex
import sys
import time
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import tyro

from tamp.data import check_writable
from tamp.errors import InputError

if TYPE_CHECKING:
    from tamp.streams.choice import Registry
    from tamp.verification.report import Report

SOLVED, NO_PLAN, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


@dataclass(frozen=True)
class Arguments:
    """Plan for a mobile manipulator: a goal in PDDL over a scene in YAML becomes a plan of base and arm motions.

    Example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml --seed 1 --out plan.json

    A problem in PDDL (tamp-solve domain.pddl problem.pddl) is planned as it stands, without scene and robot.

    Exit status: 0 solved, 1 no plan (with the reason), 2 bad input, 130 interrupted.
    """

    files: Annotated[
        tuple[str, ...], tyro.conf.Positional, tyro.conf.arg(metavar="[DOMAIN] PROBLEM", help_behavior_hint="")
    ]
    """Files, or names of shipped ones. The domain may be left out when the problem names it."""
    time: Annotated[float, tyro.conf.arg(metavar="SECONDS")] = 30.0
    """When to give up, counted from the start of the command."""
    seed: Annotated[int, tyro.conf.arg(metavar="NUMBER")] = 0
    """Of all randomness: the same seed gives the same plan."""
    out: Annotated[Path, tyro.conf.arg(metavar="FILE")] = Path("plan.json")
    """Where the plan is written; folders are made."""
    streams: Annotated[
        Path | None, tyro.conf.arg(metavar="FILE", help_behavior_hint="(default: beside the domain)")
    ] = None
    """The domain's streams, DOMAIN.streams.pddl."""
    sampler: Annotated[
        tyro.conf.UseAppendAction[tuple[str, ...]],
        tyro.conf.arg(metavar="RELATION=NAME", help_behavior_hint="(repeatable)"),
    ] = ()
    """Which sampler serves a relation, such as on=uniform. NAME:alone or NAME:mixed says whether the hand-made sampler
    takes part; it does unless NAME is hand-made, too."""
    algorithm: Annotated[str, tyro.conf.arg(metavar="NAME")] = "adaptive"
    """adaptive, or incremental (simple, for comparison)."""
    steering: Annotated[str, tyro.conf.arg(metavar="NAME")] = "se2"
    """How the base moves: se2 (in any direction) or reeds-shepp (like a car)."""
    search: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: greedy)")] = None
    """Of a PDDL problem: greedy (lazy, preferred operators), eager, wastar, or astar (optimal)."""
    heuristic: Annotated[str | None, tyro.conf.arg(metavar="NAME", help_behavior_hint="(default: by search)")] = None
    """Of a PDDL problem: ff, hadd, landmarks, or several with + (ff+landmarks); lmcut (astar's), hmax, blind."""
    verify: bool = False
    """Have the plan judged as by tamp-verify, and write it only when it holds."""
    json: bool = False
    """Print one JSON document instead of text."""
    quiet: bool = False
    """Print nothing but errors."""


def main(arguments: list[str] | None = None) -> None:
    """Run tamp-solve and leave the process with 0 solved, 1 no plan, 2 bad input, 130 interrupted."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without our letters is no reason to fail
    # The time that the user gives counts from here, less what the interpreter took to come here.
    started = time.monotonic() - time.process_time()
    sys.exit(run(sys.argv[1:] if arguments is None else arguments, started))


def run(arguments: list[str], started: float | None = None) -> int:
    """Run tamp-solve and return its exit code; `started` is when, on the monotonic clock, its time began."""
    try:
        return _solve(_parse(arguments), time.monotonic() if started is None else started)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return INTERRUPTED


def _parse(arguments: list[str]) -> Arguments:
    options = ["--" + option.name for option in fields(Arguments) if option.name != "files"] + ["--help"]
    for word in arguments:
        name = word.partition("=")[0]
        if name.startswith("--") and name not in options:
            raise InputError(f"unknown option '{name}'", found=name, choices=options)
    complaint = io.StringIO()
    try:
        with contextlib.redirect_stderr(complaint):
            config = (tyro.conf.FlagCreatePairsOff,)
            parsed = tyro.cli(Arguments, prog="tamp-solve", args=arguments, config=config)
    except SystemExit as end:
        if not end.code:  # --help
            raise
        raise InputError(_sentence(complaint.getvalue()), remedy="See tamp-solve --help") from None
    if not 1 <= len(parsed.files) <= 2:
        raise InputError(
            f"expected [DOMAIN] PROBLEM, found {len(parsed.files)} files",
            remedy="For example: tamp-solve domains/cupboard.pddl problems/four_objects.yaml",
        )
    if not parsed.files[-1].endswith(".pddl") and (parsed.search or parsed.heuristic):
        raise InputError("--search and --heuristic are for problems in PDDL; a scene's is chosen by --algorithm")
    if math.isnan(parsed.time) or parsed.time <= 0.0:
        raise InputError(f"--time: the time must be positive, not {parsed.time:g}")
    if abs(parsed.seed) >= 2**64:
        raise InputError("--seed: the number must be below 2**64")
    return parsed


def _sentence(box: str) -> str:
    """What tyro says in the first paragraph of its frame."""
    lines = [line.strip(" │|╭╮╰╯") for line in box.splitlines()]
    title, *said = [line for line in lines if line] or ["bad arguments"]
    paragraph: list[str] = []
    for line in said:
        if set(line) <= {"─", "-"}:
            if paragraph:
                break
            continue
        paragraph.append(line)
    return " ".join(paragraph).rstrip(".") or title


def _solve(arguments: Arguments, started: float) -> int:
    samplers = _samplers(arguments.sampler)
    check_writable(arguments.out)
    if arguments.files[-1].endswith(".pddl"):
        return _solve_symbolic(arguments, started)
    # These take a second to import; a wrong option is answered before.
    from tamp.algorithms.solution import Outcome
    from tamp.api import ALGORITHMS, solve
    from tamp.plan_file import plan_text, summary_document, write_plan
    from tamp.problem import load_problem
    from tamp.report import headline, summary

    if arguments.algorithm not in ALGORITHMS:
        what = f"unknown algorithm '{arguments.algorithm}'"
        raise InputError(what, found=arguments.algorithm, choices=ALGORITHMS)
    *domain, problem_name = arguments.files
    problem = load_problem(
        problem_name,
        domain[0] if domain else None,
        streams=arguments.streams,
        samplers=samplers,
        registry=registry(),
        steering=arguments.steering,
    )
    shown = _Progress(quiet=arguments.quiet or arguments.json)
    shown.line(headline(problem))
    solution = solve(
        problem,
        max_time=_left(arguments.time, started),
        seed=arguments.seed,
        algorithm=arguments.algorithm,
        progress=shown.update,
    )
    shown.clear()
    verdict = _judge(plan_text(solution)) if solution.solved and arguments.verify else None
    holds = solution.solved and (verdict is None or verdict.holds)
    written = write_plan(solution, arguments.out) if holds else None
    if arguments.json:
        import json

        document = summary_document(solution)
        document["plan"] = None if written is None else str(written)
        if verdict is not None:
            document["verification"] = verdict.json()
        _say(json.dumps(document, indent=2))
    else:
        shown.line(summary(solution))
        _conclude(shown, arguments, written, verdict)
    if solution.outcome is Outcome.INTERRUPTED:
        return INTERRUPTED
    return SOLVED if holds else NO_PLAN


def _solve_symbolic(arguments: Arguments, started: float) -> int:
    """A domain and a problem in PDDL."""
    from tamp.symbolic.command import plan_files

    shown = _Progress(quiet=arguments.quiet or arguments.json)
    ended = plan_files(
        arguments.files,
        search=arguments.search,
        heuristic=arguments.heuristic,
        left=lambda: _left(arguments.time, started),
        out=arguments.out,
        judge=_judge if arguments.verify else None,
        show=shown.line,
    )
    if arguments.json:
        _say(ended.json())
    _conclude(shown, arguments, ended.written, ended.verdict)
    return INTERRUPTED if ended.interrupted else SOLVED if ended.written is not None else NO_PLAN


def _conclude(shown: _Progress, arguments: Arguments, written: Path | None, verdict: Report | None) -> None:
    """The last lines: what the judge says, and where the plan is."""
    if verdict is not None:
        shown.line(f"\n{verdict.text()}")
    if written is not None:
        shown.line(f"\n{written} written. Check it: tamp-verify {shlex.quote(str(written))}")
    elif verdict is not None:
        shown.line(f"\n{arguments.out} not written: the plan does not hold.")


def registry() -> Registry:
    """The samplers that package grounding supplies in `grounding.registry.GROUNDINGS`: relation to name to a factory.

    This is the one place where the planner meets them.
    """
    if importlib.util.find_spec("grounding.registry") is None:
        return {}
    return importlib.import_module("grounding.registry").GROUNDINGS


def _left(seconds: float, started: float) -> float:
    """What remains of the time that the user gave; at least half, since a first run compiles kernels as it loads."""
    return max(seconds - (time.monotonic() - started), 0.5 * seconds)


def _judge(text: str) -> Report:
    """What the independent judge says about the plan file that would be written."""
    import json

    from tamp.verification.verify import verify

    return verify(json.loads(text))


def _samplers(pairs: tuple[str, ...]) -> dict[str, str]:
    chosen: dict[str, str] = {}
    for pair in pairs:
        relation, equals, name = pair.partition("=")
        if not (relation and equals and name):
            raise InputError(f"--sampler wants RELATION=NAME, not '{pair}'", remedy="For example: --sampler on=uniform")
        chosen[relation] = name
    return chosen


def _say(text: str) -> None:
    try:
        print(text, flush=True)
    except BrokenPipeError:  # nobody reads on: the plan is wanted all the same
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@dataclass
class _Progress:
    """A line on a terminal that is rewritten while planning goes on."""

    quiet: bool
    _started: float = field(default_factory=time.monotonic)
    _last: float = 0.0
    _shown: bool = False

    def line(self, text: str) -> None:
        """Print to stay."""
        if not self.quiet:
            _say(text)

    def update(self, effort: Any) -> None:
        """Rewrite the progress line ten times a second; elsewhere than on a terminal, print one every five seconds."""
        now = time.monotonic()
        terminal = sys.stderr.isatty()
        if self.quiet or now - self._last < (0.1 if terminal else 5.0) or (not terminal and now - self._started < 2.0):
            return
        self._last = now
        text = f"  searching   {effort.skeletons} skeletons · {effort.draws:,} samples · {now - self._started:.1f} s"
        print(f"\r{text}\x1b[K" if terminal else text, end="" if terminal else "\n", file=sys.stderr, flush=True)
        self._shown = terminal

    def clear(self) -> None:
        """Remove the progress line."""
        if self._shown:
            print("\r\x1b[K", end="", file=sys.stderr, flush=True)


if __name__ == "__main__":
    main()
