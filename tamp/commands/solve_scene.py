"""The part of tamp-solve that plans a problem with a scene: load, plan, judge, write, show."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import partial

from tamp.commands.solve_options import Arguments
from tamp.commands.solve_values import FollowUp, Judged, Planned, ReadyProblem, Request, Written
from tamp.commands.solve_verdict import closing_lines, judge_text
from tamp.errors import InputError
from tamp.geometric.samplers.choice import sampler_choices, sampler_files
from tamp.geometric.samplers.python_file import given_by_files
from tamp.plan.summary import summary_document
from tamp.plan.write import plan_text, write_plan
from tamp.planner.parallel import solve_parallel
from tamp.planner.problem import load_problem
from tamp.planner.report import headline, improvement, summary
from tamp.planner.solution import Solution
from tamp.planner.solve import ALGORITHMS
from tamp.planner.statistics_file import add_statistics, read_statistics
from tamp.symbolic.algorithms.result import Outcome
from tamp.system import guard
from tamp.system.outputs import check_outputs
from tamp.system.progress import Progress, say
from tamp.view.external_meshes import check_inside
from tamp.view.outputs import OutputRequest, check_page, write_outputs


def solve_scene(request: Request) -> bool | None:
    """Plan a problem with a scene, and write and show what is asked for.

    Args:
        request: What is asked for.

    Returns:
        Whether there is a plan that holds, and reaches the goal where it was carried out; None
        when the user has ended it.

    Raises:
        InputError: Anything wrong with the files or the names, with its place.
    """
    options, shown = request.options, request.shown
    outputs = _requested_outputs(options)

    loaded = load(request)
    planned = plan(request, loaded, outputs.page)
    judged = judge(request, loaded, planned)
    written = write(request, loaded, planned, judged)
    followed = follow_up(request, loaded, planned, written)
    tell(request, loaded, planned, judged, written, followed)

    if planned.stopped and (outputs.any or options.verify or options.scene.execute):
        shown.line("interrupted: the plan was neither judged, carried out nor drawn")
        return None
    show(outputs, planned, shown)

    if written.error is not None:
        raise written.error
    if planned.solution.outcome is Outcome.INTERRUPTED:
        return None
    return judged.holds and (followed.execution is None or followed.execution.reached)


def load(request: Request) -> ReadyProblem:
    """Load the problem; refuse outputs that would overwrite what it was read from."""
    options, shown = request.options, request.shown
    named = sampler_choices(options.scene.sampler)
    samplers, groundings = given_by_files(named)
    *domain, problem_name = options.files
    load_again = partial(
        load_problem,
        problem_name,
        domain[0] if domain else None,
        streams=options.scene.streams,
        samplers=samplers,
        groundings=groundings,
        registry=request.registry,
        steering=options.scene.steering,
        planner=options.scene.planner,
        robot=options.scene.robot,
    )
    shown.begin("loading")
    problem = load_again()

    read = [file for files in problem.files.values() for file in files]
    check_outputs(
        options.outputs, (*read, *sampler_files((*problem.samplers.values(), *named.values())))
    )
    if options.scene.html is not None:
        check_page(options.scene.html)
        if not options.scene.allow_outside:
            shown_meshes = (*problem.files["meshes"], *problem.files["drawn"])
            check_inside(shown_meshes, problem.files["problem"][0])

    if options.scene.statistics is not None:
        domain_name = problem.stream_task.task.domain.name
        statistics = read_statistics(options.scene.statistics, domain_name)
        problem = replace(problem, stream_task=replace(problem.stream_task, posteriors=statistics))

    shown.line(headline(problem))
    return ReadyProblem(problem, load_again, request.budget.elapsed())


def plan(request: Request, loaded: ReadyProblem, record: bool) -> Planned:
    """Plan; of several processes, the first plan that the judge accepts counts."""
    options, shown = request.options, request.shown
    shown.begin("searching")

    def improved(better: Solution) -> None:
        shown.clear()
        shown.line(improvement(better))

    def accepted(found: Solution) -> bool:
        return judge_text(plan_text(found), loaded.problem.classifiers).holds

    solution = solve_parallel(
        loaded.problem,
        jobs=options.jobs,
        max_time=request.budget.left(),
        seed=options.seed,
        algorithm=options.scene.algorithm,
        progress=shown.update,
        accept=accepted if options.verify else None,
        improved=improved if options.optimize else None,
        record=options.scene.record or record,
    )
    shown.clear()
    return Planned(solution, guard.asked() or solution.outcome is Outcome.INTERRUPTED)


def judge(request: Request, loaded: ReadyProblem, planned: Planned) -> Judged:
    """Ask the independent judge, if that is wanted."""
    options, shown = request.options, request.shown
    solution = planned.solution
    if not solution.solved or not options.verify or planned.stopped:
        return Judged(None, solution.solved)

    shown.begin("judging")
    verdict = judge_text(plan_text(solution), loaded.problem.classifiers)
    return Judged(verdict, verdict.holds)


def write(request: Request, loaded: ReadyProblem, planned: Planned, judged: Judged) -> Written:
    """Write the plan first of all: what fails later loses no plan. Then add to the statistics."""
    options, shown = request.options, request.shown
    shown.begin("writing")
    written = write_plan(planned.solution, options.out) if judged.holds else None

    if options.scene.statistics is None:
        return Written(written, None)
    try:
        add_statistics(options.scene.statistics, loaded.domain_name, planned.solution.statistics)
    except InputError as error:
        return Written(written, error)
    return Written(written, None)


def follow_up(
    request: Request, loaded: ReadyProblem, planned: Planned, written: Written
) -> FollowUp:
    """Look for what would make the problem solvable, or carry the plan out, if that is wanted."""
    options, shown = request.options, request.shown
    because, executed = None, None
    solution = planned.solution

    if options.scene.why and not solution.solved and not planned.stopped:
        from tamp.planner.suggestions.why import suggest_changes

        looking = "looking for changes that would make it solvable ..."
        shown.line(f"{summary(solution, loaded.seconds)}\n\n  {looking}")
        because = suggest_changes(
            solution,
            lambda scene: loaded.load(scene=scene),
            max_time=options.time,
            progress=shown.update,
            trying=shown.begin,
        )
        shown.clear()

    if options.scene.execute and written.plan is not None and not planned.stopped:
        from tamp.execution.command import Options, carry_out

        shown.begin("executing")
        how = Options(grasp=options.scene.grasp, seed=options.seed, sampler=options.scene.sampler)
        executed = carry_out(written.plan, how, request.registry)
    return FollowUp(because, executed)


def tell(
    request: Request,
    loaded: ReadyProblem,
    planned: Planned,
    judged: Judged,
    written: Written,
    followed: FollowUp,
) -> None:
    """Print how it ended: one JSON document, or lines."""
    options, shown = request.options, request.shown
    if options.json:
        say(json.dumps(_document(planned, judged, written, followed), indent=2))
        return

    because, executed = followed.why, followed.execution
    shown.line(summary(planned.solution, loaded.seconds) if because is None else because.text())
    for line in closing_lines(options.out, written.plan, judged.verdict):
        shown.line(line)
    if executed is not None:
        shown.line(f"\n{executed.text()}")


def show(outputs: OutputRequest, planned: Planned, shown: Progress) -> None:
    """Draw the plan, or what was tried, where that is wanted."""
    if not outputs.any:
        return
    from tamp.view.open import timeline_of_solution

    shown.begin("drawing")
    write_outputs(outputs, *timeline_of_solution(planned.solution), None, shown.line)


def _document(
    planned: Planned, judged: Judged, written: Written, followed: FollowUp
) -> dict[str, object]:
    """Collect what `--json` prints."""
    document: dict[str, object] = dict(summary_document(planned.solution))
    document["plan"] = None if written.plan is None else str(written.plan)
    if judged.verdict is not None:
        document["verification"] = judged.verdict.json()
    if followed.why is not None:
        document["why"] = followed.why.json()
    if followed.execution is not None:
        document["execution"] = followed.execution.json()
    return document


def _requested_outputs(options: Arguments) -> OutputRequest:
    """Refuse an unknown algorithm and what cannot be shown before time is spent."""
    scene = options.scene
    if scene.algorithm not in ALGORITHMS:
        what = f"unknown algorithm '{scene.algorithm}'"
        raise InputError(what, found=scene.algorithm, choices=ALGORITHMS)

    outputs = OutputRequest(html=scene.html, png=scene.png, video=scene.video, view=scene.view)
    if outputs.any:
        outputs.check()
    return outputs
