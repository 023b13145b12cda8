"""The planner's ways on a random problem, each plan judged by the book."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

from tamp.pddlstream import from_gen_fn, from_list_fn, from_test
from tamp.pddlstream import solve as solve_pddlstream
from tamp.stream import Call, Rejection
from tamp.symbolic.algorithms.anytime import solve_anytime
from tamp.symbolic.algorithms.bound_stream import BoundStream
from tamp.symbolic.algorithms.costs import BoundFunction
from tamp.symbolic.algorithms.registry import ALGORITHMS
from tamp.symbolic.algorithms.result import Outcome, Result, SearchStatistics, StreamTask
from tamp.symbolic.pddl.parser import (
    output_types,
    parse_domain,
    parse_facts,
    parse_goal,
    parse_streams,
)
from tamp.symbolic.pddl.relations import SAMPLE_PREFIX
from tamp.symbolic.pddl.structs import Task
from tamp.system.deadline import Deadline, OutOfTime
from tests.random_streams.oracle import World
from tests.random_streams.problems import (
    CONSTANTS,
    Atom,
    Formula,
    Problem,
    Source,
    domain_text,
    streams_text,
    text,
)

STATES = 300
"""States that the brute force looks at; then it does not say that there is no plan."""

Row = dict[str, Any]


class Verdict(NamedTuple):
    """How a run ended, what is wrong with its plan, and how many plans it dropped in the replay."""

    outcome: Outcome
    fault: str | None = None
    refuted: int = 0


Way = Callable[[Problem], Verdict]


def stream_function(problem: Problem, source: Source) -> Callable[..., Any]:
    """The stream's function as the planner calls it; tries fail now and then."""

    def rows(*inputs: str, call: Call) -> Sequence[Atom]:
        return problem.table(
            source, inputs, frozenset(tuple(map(str, fact)) for fact in call.fluents)
        )

    def generate(*inputs: str, call: Call) -> Iterator[Any]:
        for row in rows(*inputs, call=call):
            if call.rng.random() < 0.3:
                yield Rejection("not this time")
            yield row if len(row) != 1 else row[0]

    def test(*inputs: str, call: Call) -> bool:
        return bool(rows(*inputs, call=call))

    return generate if source.outputs else test


def stream_task(problem: Problem) -> StreamTask:
    """The problem for the algorithms."""
    domain = parse_domain(domain_text(problem))
    declared = parse_streams(streams_text(problem), domain)
    sources = {source.name: source for source in problem.sources}
    bound: list[BoundStream] = []
    for stream in declared.streams:
        types = output_types(stream, domain)
        function = stream_function(problem, sources[stream.name])
        outputs = tuple(types[name] for name in stream.outputs)
        advises = stream.name.startswith(SAMPLE_PREFIX)
        bound.append(BoundStream(stream, function, outputs, advises))
    functions = tuple(
        BoundFunction(one, partial(problem.price, one.name)) for one in declared.functions
    )
    objects = {name: (kind,) for name, kind in problem.objects.items() if name not in CONSTANTS}
    facts = parse_facts(" ".join(map(text, sorted(problem.init))), domain, objects)
    task = Task(
        "random", domain, objects, facts, parse_goal(text(problem.goal), domain, objects), {}
    )
    return StreamTask(
        task, tuple(bound), {name: name for name in objects}, functions, by_value=problem.pooled
    )


def fault(
    problem: Problem,
    plan: Sequence[tuple[str, tuple[str, ...], float]],
    certified: Sequence[Atom],
    types: dict[str, str] | None = None,
) -> str | None:
    """What is wrong with a plan: with all that streams give, and with nothing but what it says it rests on."""
    world = World(problem)
    shown = {atom[0] for source in problem.sources if source.fluents for atom in source.certified}
    for fact in certified:
        if fact not in world.static and fact[0] not in shown:
            return f"{fact} was never certified"
    said = world.fault(plan)
    if said is not None:
        return said
    kinds = {value: kind for kind, values in world.universe.items() for value in values}
    kinds |= {value: "way" for fact in certified for value in fact[1:] if value.startswith("way")}
    used = {value for _, values, _ in plan for value in values} | {
        value for fact in certified for value in fact[1:]
    }
    extra = {value: kinds[value] for value in used - problem.objects.keys()}
    still = [fact for fact in certified if fact[0] not in shown]
    alone = World(problem, still, extra, (world, frozenset(certified))).fault(plan)
    return None if alone is None else f"with what it rests on alone: {alone}"


def judged(problem: Problem, result: Result) -> str | None:
    """The fault of an algorithm's plan."""
    values = result.objects.values
    plan = [(a.name, tuple(values[word] for word in a.arguments), a.cost) for a in result.actions]
    certified = [(fact[0], *(values[word] for word in fact[1:])) for fact in result.certified]
    return fault(problem, plan, certified)


def run_algorithm(problem: Problem, name: str, seconds: float, seed: int = 0) -> Verdict:
    """How an algorithm ends, and what is wrong with its plan."""
    result = ALGORITHMS[name](
        stream_task(problem),
        lambda key: random.Random(f"{seed} {key}"),
        Deadline(seconds),
        lambda effort: None,
    )
    said = judged(problem, result) if result.outcome is Outcome.SOLVED else None
    return Verdict(result.outcome, said, result.effort.refuted)


def run_anytime(problem: Problem, seconds: float, rounds: int, seed: int = 0) -> Verdict:
    """The same of `--optimize`, all its plans judged; it is stopped after so many rounds."""
    faults: list[str | None] = []
    refuted = 0
    costs: list[float] = []
    deadline = Deadline(seconds)
    left = rounds

    def better(result: Result) -> bool:
        nonlocal refuted
        refuted = result.effort.refuted
        faults.append(judged(problem, result))
        costs.append(sum(action.cost for action in result.actions))
        return len(costs) == 1 or costs[-1] <= min(costs)

    def progress(effort: SearchStatistics) -> None:
        nonlocal left
        left -= bool(costs)
        if left <= 0:
            raise OutOfTime

    try:
        outcome = solve_anytime(
            stream_task(problem),
            lambda key: random.Random(f"{seed} {key}"),
            deadline,
            progress,
            better,
            lambda bound: None,
            random.Random(seed),
        ).outcome
    except OutOfTime:
        outcome = Outcome.SOLVED if costs else Outcome.TIMEOUT
    return Verdict(outcome, next((one for one in faults if one is not None), None), refuted)


def run_pddlstream(problem: Problem, algorithm: str, seconds: float, seed: int = 0) -> Verdict:
    """The same by way of PDDLStream's problem tuple."""

    def adapted(source: Source) -> Any:
        def rows(*inputs: str, fluents: Sequence[Atom] = ()) -> Sequence[Atom]:
            return problem.table(
                source, inputs, frozenset(tuple(map(str, fact)) for fact in fluents)
            )

        if not source.outputs:
            return from_test(lambda *inputs, **shown: bool(rows(*inputs, **shown)))
        if problem.seed % 2:
            return from_list_fn(rows)
        return from_gen_fn(lambda *inputs, **shown: iter(rows(*inputs, **shown)))

    stream_map: dict[str, Any] = {source.name: adapted(source) for source in problem.sources}
    stream_map |= {name: partial(problem.price, name) for name in problem.functions}
    init = [*sorted(problem.init), *((kind, name) for name, kind in problem.objects.items())]
    solution = solve_pddlstream(
        (domain_text(problem), {}, streams_text(problem), stream_map, init, _listed(problem.goal)),
        algorithm,
        max_time=seconds,
        seed=seed,
    )
    if not solution.solved:
        return Verdict(solution.outcome, None, solution.effort.refuted)
    acts = {act.name: act for act in problem.acts}
    plan: list[tuple[str, tuple[str, ...], float]] = []
    for action in solution.plan or ():
        act = acts[action.name]
        names = [name for name, _ in act.params]
        cost = act.cost
        due = (
            problem.price(cost[0], action.args[names.index(cost[1])])
            if isinstance(cost, tuple)
            else cost
        )
        plan.append((action.name, action.args, due))
    said = fault(problem, plan, [tuple(fact) for fact in solution.certificate])
    return Verdict(solution.outcome, said, solution.effort.refuted)


def _listed(formula: Formula) -> Any:
    """A condition in PDDLStream's form, variables with their types as lists of words."""
    if formula[0] in ("exists", "forall"):
        words = [word for name, kind in formula[1] for word in (name, "-", kind)]
        return (formula[0], words, _listed(formula[2]))
    return tuple(_listed(part) if isinstance(part, tuple) else part for part in formula)


def compare(problem: Problem, ways: dict[str, Way]) -> Row:
    """The brute force and the planner's ways: what each says, which plans are wrong, missed, or dropped by itself."""
    solvable = World(problem).solvable(STATES)
    row: Row = {
        "seed": problem.seed,
        "solvable": solvable,
        "wrong": {},
        "missed": {},
        "refuted": {},
    }
    for name, way in ways.items():
        outcome, said, refuted = way(problem)
        row[name] = outcome.name
        if refuted:
            row["refuted"][name] = refuted
        if said is not None:
            row["wrong"][name] = said
        elif outcome is Outcome.SOLVED and solvable is False:
            row["wrong"][name] = "the brute force finds no plan"
        elif outcome is Outcome.INFEASIBLE and solvable:
            row["wrong"][name] = "it is called infeasible, and the brute force finds a plan"
        elif outcome is not Outcome.SOLVED and solvable:
            row["missed"][name] = outcome.name
    return row
