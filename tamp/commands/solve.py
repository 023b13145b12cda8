"""tamp-solve: a domain and a problem in, a plan file out."""

from __future__ import annotations

import importlib
import importlib.util
import shlex
import sys
import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

from tamp.commands.solve_options import Arguments, parsed
from tamp.errors import InputError
from tamp.geometric.samplers.choice import sampler_choices
from tamp.system import guard
from tamp.system.outputs import check_outputs, check_writable
from tamp.system.progress import Progress, say
from tamp.system.terminal import spoken

if TYPE_CHECKING:
    from tamp.execution.report import Execution
    from tamp.geometric.samplers.choice import Registry
    from tamp.geometric.scene.classifier import Classifier
    from tamp.planner.solution import Solution
    from tamp.verification.report import Report

SOLVED, NO_PLAN, BAD_INPUT, INTERRUPTED = 0, 1, 2, 130


def main() -> NoReturn:
    """Run tamp-solve and leave the process with 0 solved, 1 no plan, 2 bad input, 130 or 143 interrupted."""
    if not guard.is_guarded():
        guard.guarded("tamp.commands.solve")
    # The time that the user gives counts from here, less what the interpreter took to come here.
    started = time.monotonic() - time.process_time()
    guard.leave_as(spoken(run)(sys.argv[1:], started))


def execute(arguments: list[str] | None = None) -> None:
    """Run tamp-execute."""
    from tamp.commands.execute import main

    sys.exit(spoken(main)(sys.argv[1:] if arguments is None else arguments, registry))


def run(arguments: list[str], started: float | None = None) -> int:
    """Run tamp-solve and return its exit code; `started` is when, on the monotonic clock, its time began."""
    try:
        return _solve(parsed(arguments), time.monotonic() if started is None else started)
    except InputError as error:
        _hush()
        print(f"error: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        _hush()
        print("interrupted", file=sys.stderr)
        return INTERRUPTED
    finally:
        _hush()


_SHOWN: list[Progress] = []
"""What speaks while the command works."""


def _hush() -> None:
    while _SHOWN:
        _SHOWN.pop().end()


def _solve(arguments: Arguments, started: float) -> int:
    samplers = sampler_choices(arguments.sampler)
    for option, file in arguments.outputs.items():
        if file is not None:
            check_writable(file, option)
    if arguments.files[-1].endswith(".pddl"):
        return _solve_symbolic(arguments, started)
    # These take a second to import; a wrong option is answered before.
    from tamp.system import compilation

    shown = Progress(quiet=arguments.quiet or arguments.json)
    _SHOWN.append(shown)
    compilation.tell(shown.compiling)
    from tamp.geometric.samplers.choice import sampler_files
    from tamp.geometric.samplers.python_file import given_by_files
    from tamp.plan.write import plan_text, summary_document, write_plan
    from tamp.planner.parallel import solve_parallel
    from tamp.planner.problem import load_problem
    from tamp.planner.report import headline, improvement, summary
    from tamp.planner.solve import ALGORITHMS
    from tamp.planner.statistics_file import add_statistics, read_statistics
    from tamp.planner.suggestions.why import why
    from tamp.symbolic.algorithms.result import Outcome
    from tamp.view.outputs import Wishes, fulfil
    from tamp.view.outside import check_inside

    if arguments.algorithm not in ALGORITHMS:
        what = f"unknown algorithm '{arguments.algorithm}'"
        raise InputError(what, found=arguments.algorithm, choices=ALGORITHMS)
    wishes = Wishes(html=arguments.html, png=arguments.png, video=arguments.video, view=arguments.view)
    if wishes.any:
        wishes.check()
    given_names = samplers
    samplers, groundings = given_by_files(samplers)
    *domain, problem_name = arguments.files
    load = partial(
        load_problem,
        problem_name,
        domain[0] if domain else None,
        streams=arguments.streams,
        samplers=samplers,
        groundings=groundings,
        registry=registry(),
        steering=arguments.steering,
    )
    shown.begin("loading")
    problem = load()
    domain_name = problem.stream_task.task.domain.name
    given = sampler_files((*problem.samplers.values(), *given_names.values()))
    check_outputs(arguments.outputs, (*(file for files in problem.files.values() for file in files), *given))
    if arguments.html is not None and not arguments.allow_outside:
        check_inside((*problem.files["meshes"], *problem.files["drawn"]), problem.files["problem"][0])
    if arguments.statistics is not None:
        known = read_statistics(arguments.statistics, domain_name)
        problem = replace(problem, stream_task=replace(problem.stream_task, known=known))
    shown.line(headline(problem))
    shown.begin("searching")
    loading = time.monotonic() - started

    def improved(plan: Solution) -> None:
        shown.clear()
        shown.line(improvement(plan))

    solution = solve_parallel(
        problem,
        jobs=arguments.jobs,
        max_time=_left(arguments.time, started),
        seed=arguments.seed,
        algorithm=arguments.algorithm,
        progress=shown.update,
        accept=(lambda plan: _judge(plan_text(plan), problem.classifiers).holds) if arguments.verify else None,
        improved=improved if arguments.optimize else None,
        record=arguments.record or wishes.page,
    )
    shown.clear()
    stopped = guard.asked() or solution.outcome is Outcome.INTERRUPTED  # then what was found is kept, and nothing begun
    shown.begin("judging")
    judged = solution.solved and arguments.verify and not stopped
    verdict = _judge(plan_text(solution), problem.classifiers) if judged else None
    holds = solution.solved and (verdict is None or verdict.holds)
    shown.begin("writing")
    written = write_plan(solution, arguments.out) if holds else None  # first of all: what fails later loses no plan
    later = None
    if arguments.statistics is not None:
        try:
            add_statistics(arguments.statistics, domain_name, solution.statistics)
        except InputError as error:
            later = error
    because = None
    if arguments.why and not solution.solved and not stopped:
        shown.line(f"{summary(solution, loading)}\n\n  looking for changes that would make it solvable ...")
        because = why(
            solution, lambda scene: load(scene=scene), max_time=arguments.time,
            progress=shown.update, trying=shown.begin,
        )  # fmt: skip
        shown.clear()
    executed = None
    if written is not None and arguments.execute and not stopped:
        shown.begin("executing")
        executed = _execute(written, arguments)
    if arguments.json:
        import json

        document = summary_document(solution)
        document["plan"] = None if written is None else str(written)
        if verdict is not None:
            document["verification"] = verdict.json()
        if because is not None:
            document["why"] = because.json()
        if executed is not None:
            document["execution"] = executed.json()
        say(json.dumps(document, indent=2))
    else:
        shown.line(summary(solution, loading) if because is None else because.text())
        _conclude(shown, arguments, written, verdict)
        if executed is not None:
            shown.line(f"\n{executed.text()}")
    if stopped and (wishes.any or arguments.verify or arguments.execute):
        shown.line("interrupted: the plan was neither judged, carried out nor drawn")
        return INTERRUPTED
    if wishes.any:
        from tamp.view.open import film_of_solution

        shown.begin("drawing")
        fulfil(wishes, *film_of_solution(solution), None, shown.line)
    if later is not None:
        raise later
    if solution.outcome is Outcome.INTERRUPTED:
        return INTERRUPTED
    return SOLVED if holds and (executed is None or executed.reached) else NO_PLAN


def _execute(plan: Path, arguments: Arguments) -> Execution:
    """The plan that was just written, carried out in physics."""
    from tamp.execution.command import Options, carry_out

    return carry_out(plan, Options(grasp=arguments.grasp, seed=arguments.seed, sampler=arguments.sampler), registry())


def _solve_symbolic(arguments: Arguments, started: float) -> int:
    """A domain and a problem in PDDL."""
    from tamp.commands.solve_pddl import plan_files
    from tamp.system.files import find_domain

    *domain, problem = arguments.files
    check_outputs(arguments.outputs, (*(find_domain(name) for name in domain), Path(problem)))
    shown = Progress(quiet=arguments.quiet or arguments.json)
    _SHOWN.append(shown)
    shown.begin("searching")
    ended = plan_files(
        arguments.files,
        search=arguments.search,
        heuristic=arguments.heuristic,
        jobs=arguments.jobs,
        optimize=arguments.optimize,
        left=lambda: _left(arguments.time, started),
        out=arguments.out,
        judge=_judge if arguments.verify else None,
        show=shown.line,
    )
    if arguments.json:
        say(ended.json())
    _conclude(shown, arguments, ended.written, ended.verdict)
    return INTERRUPTED if ended.interrupted else SOLVED if ended.written is not None else NO_PLAN


def _conclude(shown: Progress, arguments: Arguments, written: Path | None, verdict: Report | None) -> None:
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


def _judge(text: str, classifiers: Mapping[str, Classifier] | None = None) -> Report:
    """What the independent judge says about the plan file that would be written, asking the user's classifiers."""
    import json

    from tamp.verification.verify import verify

    return verify(json.loads(text), classifiers=classifiers or {})


if __name__ == "__main__":
    main()
