"""Reading what a problem consists of: its YAML, its domain, the domain's streams; the start and the
goal in the domain's words.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem, load_scene
from tamp.geometric.loading.robots import load_robot
from tamp.geometric.scene.scene import Scene
from tamp.geometric.values import Grasp
from tamp.planner.initial_state import InitialState, declares_arms, initial_state
from tamp.planner.movable_places import carries, check_circle, place_facts, remedied, with_tops
from tamp.planner.wanted_relations import wanted_facts
from tamp.relations.observed import scene_names
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain, parse_facts, parse_goal, parse_streams
from tamp.symbolic.pddl.structs import Domain, Formula, StreamFile
from tamp.system.files import find_domain

METRIC = "minimize total-cost"
"""The metric that a problem may name."""


@dataclass(frozen=True)
class ProblemFiles:
    """The contents of a problem's files, as far as each can be understood by itself."""

    loaded: LoadedProblem
    domain: Domain
    domain_path: Path
    streams: StreamFile
    streams_path: Path

    def by_role(self) -> dict[str, tuple[Path, ...]]:
        """List the files as `Problem.files` has them."""
        return {
            "problem": (self.loaded.path.resolve(),),
            "domain": (self.domain_path.resolve(),),
            "streams": (self.streams_path.resolve(),),
            "meshes": tuple(path.resolve() for path in self.loaded.meshes),
            "drawn": tuple(path.resolve() for path in self.loaded.drawn),
        }


def read_files(
    problem: str | Path,
    domain: str | Path | None,
    streams: str | Path | None,
    scene: Scene | None,
    robot: str | None,
) -> ProblemFiles:
    """Read the problem, its domain and the domain's streams; take the scene as it is by now."""
    loaded = load_scene(problem, robot)
    if scene is not None:
        loaded = replace(loaded, scene=scene)

    domain_path = _domain_path(loaded, domain)
    parsed = parse_domain(read_pddl(domain_path), domain_path)
    if carries(parsed):
        loaded = replace(loaded, scene=with_tops(loaded.scene))

    beside = domain_path.with_suffix(".streams.pddl")
    streams_path = Path(streams) if streams is not None else beside
    if streams is None and not beside.exists():
        raise InputError(
            f"no such file: the streams of '{domain_path.name}' are looked for beside it",
            file=beside,
            remedy="--streams FILE names others",
        )
    declared = parse_streams(read_pddl(streams_path), parsed, streams_path)
    return ProblemFiles(loaded, parsed, domain_path, declared, streams_path)


def parse_task(files: ProblemFiles, holding: Grasp | None) -> tuple[InitialState, Formula]:
    """Say the scene in the domain's words, with the facts that the file adds; parse the goal."""
    loaded, domain = files.loaded, files.domain
    arms = _arms(loaded) if declares_arms(domain) else ()
    start = initial_state(loaded.scene, domain, holding, arms)

    try:
        goal = parse_goal(
            loaded.goal.text, domain, start.objects, loaded.path,
            line_offset=loaded.goal.line - 1, column_offset=loaded.goal.column - 1,
        )  # fmt: skip
    except InputError as error:
        raise remedied(error, domain) from None
    for passage in loaded.init:
        start.facts |= parse_facts(
            passage.text, domain, start.objects, loaded.path,
            line_offset=passage.line - 1, column_offset=passage.column - 1,
        )  # fmt: skip

    if carries(domain):
        start.facts |= place_facts(loaded.scene, domain, goal)
        check_circle(loaded, goal)
    start.facts |= wanted_facts(
        files.streams, domain, goal, start.objects, start.facts, scene_names(loaded.scene)
    )

    _check_metric(loaded)
    return start, goal


def _arms(loaded: LoadedProblem) -> tuple[str, ...]:
    """List the names of the robot's arms, which are objects of the domain.

    Raises:
        InputError: A body or a place has such a name.
    """
    arms = tuple(arm.arm for arm in load_robot(loaded.scene.robot.model).arms)
    scene = loaded.scene
    for name in (*scene.bodies, *scene.surfaces, *scene.cavities):
        if name.lower() in arms:
            remedy = "Give it another name"
            raise loaded.error(f"'{name}' is the name of one of the robot's arms", name, remedy)
    return arms


def _domain_path(loaded: LoadedProblem, domain: str | Path | None) -> Path:
    if domain is not None:
        return find_domain(domain)
    if loaded.domain is None:
        raise loaded.error(
            "no domain",
            remedy="Name one in the file (domain: cupboard) or on the command line, "
            "before the problem",
        )
    try:
        return find_domain(loaded.domain, loaded.path.parent)
    except InputError as error:
        raise error.at(loaded.path, loaded.line_of("domain")) from None


def _check_metric(loaded: LoadedProblem) -> None:
    metric = loaded.metric
    if (
        metric is not None
        and " ".join(metric.text.lower().replace("(", " ").replace(")", " ").split()) != METRIC
    ):
        remedy = "The one that there is: (minimize (total-cost))"
        raise InputError(
            f"unknown metric '{metric.text}'", file=loaded.path, line=metric.line, remedy=remedy
        )
