"""Load a problem from files: the scene, the symbolic task, the streams tied to their functions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from tamp.errors import InputError
from tamp.geometric.context import Context
from tamp.geometric.loading.load import LoadedProblem
from tamp.geometric.loading.overlaps import check_overlaps
from tamp.geometric.loading.robots import ASSETS, ROBOTS, load_robot
from tamp.geometric.motion.planners import COMPILED, PLANNERS, STEERINGS, STEERINGS_OF
from tamp.geometric.robot.robot import Robot
from tamp.geometric.samplers.choice import Grounding, Registry, make_mixture
from tamp.geometric.samplers.registry import SAMPLERS
from tamp.geometric.scene.classifier import Classifier
from tamp.geometric.scene.scene import Scene
from tamp.geometric.stability.hulls import prepare
from tamp.geometric.values import Grasp
from tamp.planner.own_relations import decided
from tamp.planner.problem_files import ProblemFiles, parse_task, read_files
from tamp.planner.relation_samplers import Served
from tamp.planner.stream_binding import bind, bind_costs, unused_functions
from tamp.planner.stream_completion import saying_where_poses_rest
from tamp.planner.wanted_relations import unasked_streams
from tamp.symbolic.algorithms.result import StreamTask
from tamp.symbolic.pddl.lint import lint
from tamp.symbolic.pddl.relations import Relation
from tamp.symbolic.pddl.structs import Task


@dataclass(frozen=True)
class Problem:
    """Everything that planning needs.

    Attributes:
        name: The problem's.
        scene: Its geometry.
        context: What its streams share.
        stream_task: The task in symbols with its streams.
        goal: The goal's text.
        files: Input files by role: "problem", "domain", "streams", and "mesh" ones.
        samplers: Which sampler serves which relation.
        warnings: What was repaired or looks odd.
        classifiers: By relation of the user's own, what says whether it holds.
        relations: The same relations: their facts and of what they are asked.
        complements: Predicates of the task that the user's files do not have.
        robot_given: Whether the robot is another one than the problem's file names.
    """

    name: str
    scene: Scene
    context: Context
    stream_task: StreamTask
    goal: str
    files: Mapping[str, tuple[Path, ...]]
    samplers: Mapping[str, str]
    warnings: tuple[str, ...]
    classifiers: Mapping[str, Classifier] = field(default_factory=dict[str, Classifier])
    relations: Mapping[str, Relation] = field(default_factory=dict[str, Relation])
    complements: frozenset[str] = frozenset()
    robot_given: bool = False


def load_problem(
    problem: str | Path,
    domain: str | Path | None = None,
    *,
    streams: str | Path | None = None,
    samplers: Mapping[str, str] | None = None,
    groundings: Mapping[str, Grounding] | None = None,
    registry: Registry | None = None,
    functions: Mapping[str, Callable[..., Any]] | None = None,
    steering: str | None = None,
    planner: str = COMPILED,
    robot: str | Path | None = None,
    scene: Scene | None = None,
    holding: Grasp | None = None,
) -> Problem:
    """Load a problem.

    Args:
        problem: A YAML file, or the name of a shipped problem.
        domain: A PDDL file or the name of a shipped domain; by default the one that the problem
            names.
        streams: The streams file; by default `<domain>.streams.pddl` beside the domain.
        samplers: Relation to the sampler that serves it, over those that the problem names: NAME,
            NAME:mixed or NAME:alone. Hand-made ones are alone by themselves, others are mixed with
            the first hand-made one.
        groundings: Relation to an object with `propose`, and `classify` where the domain asks for
            it, over all named samplers; its name is "given" (samplers={"on": "given:alone"} has it
            alone). A relation of the user's own is served to the streams sample-<relation> and
            test-<relation>.
        registry: Further samplers: relation to name to what makes the object; also of files
            (`samplers.choice`).
        functions: Further stream functions by name, f(context, *inputs, call=...), and those that
            compute costs, f(context, *inputs).
        steering: How the base moves: "se2", "reeds-shepp" or "differential"; by default as the
            robot drives.
        planner: How the ways of arm and base are searched: "compiled" (RRT-Connect over the
            compiled collision kernel) or "ompl" (OMPL's RRTConnect, the reference).
        robot: A shipped robot's name or a robot's folder, instead of the one that the file names.
        scene: Where things are by now, instead of where the file has them; and what is in the hand
            by now, `holding`.

    Raises:
        InputError: Anything wrong with the files or the names, with its place.
    """
    if steering is not None and steering not in STEERINGS:
        raise InputError(f"unknown steering '{steering}'", found=steering, choices=STEERINGS)
    if planner not in PLANNERS:
        raise InputError(f"unknown planner '{planner}'", found=planner, choices=PLANNERS)

    files = read_files(problem, domain, streams, scene, None if robot is None else str(robot))
    start, goal = parse_task(files, holding)

    served = Served.of(files.loaded, samplers or {}, groundings or {}, registry or {})
    own = [name for name in served.generators if name not in SAMPLERS]
    said = saying_where_poses_rest(files.streams, files.domain, own, functions or {})
    files = replace(files, streams=said)
    context = _context(files, served, steering, planner, holding)
    if scene is None:  # what is seen may touch
        check_overlaps(files.loaded)
    _check_start(files.loaded, context)

    given = functions or {}
    functions_by_name = {**served.functions(files.streams, files.domain), **given}
    unasked = unasked_streams(files.streams, files.domain, goal)
    bound = bind(files.streams, files.domain, context, functions_by_name, unasked)
    decision = decided(
        served, files.streams, files.domain, goal, start.objects, start.facts, context
    )
    costs = bind_costs(files.streams, context, given)

    name = files.loaded.scene.name
    task = Task(
        name,
        decision.domain,
        start.objects,
        frozenset(start.facts) | decision.facts,
        decision.goal,
        {},
    )
    return Problem(
        name=name,
        scene=files.loaded.scene,
        context=context,
        stream_task=StreamTask(task, (*bound, *decision.streams), start.values, costs),
        goal=" ".join(files.loaded.goal.text.split()),
        files={**files.by_role(), "robot": _own_robot(context.robot)},
        samplers={relation: choice.text for relation, choice in served.choices.items()},
        warnings=(
            *files.loaded.warnings,
            *unused_functions(files.streams, given),
            *lint(files.domain, files.streams, goal, start.facts),
            *decision.warnings,
        ),
        classifiers=decision.classifiers,
        relations=decision.relations,
        complements=decision.complements,
        robot_given=robot is not None,
    )


def _context(
    files: ProblemFiles, served: Served, steering: str | None, planner: str, holding: Grasp | None
) -> Context:
    """Make what all streams share: the scene, the robot, the samplers mixed with hand-made ones."""
    scene = files.loaded.scene
    mixtures = {
        relation: make_mixture(relation, served.choices[relation], made)
        for relation, made in served.generators.items()
    }
    robot = load_robot(scene.robot.model)
    can = STEERINGS_OF[robot.drive]
    if steering is not None and steering not in can:
        raise InputError(
            f"the base of {robot.name} cannot move by '{steering}': its drive is {robot.drive}",
            choices=can,
        )
    context = Context(scene, robot, mixtures, steering or can[0], holding, planner)
    prepare(scene.bodies[name] for name in scene.movable)
    if robot.drive != "fixed":
        _ = context.reachability  # read now: what is damaged is told before planning
        for arm in robot.beside:
            _ = context.of_arm(arm.arm).reachability
    return context


def _own_robot(robot: Robot) -> tuple[Path, ...]:
    """List the files of a robot that does not come with tamp."""
    return () if robot.name in ROBOTS and robot.folder.parent == ASSETS else robot.files


def _check_start(loaded: LoadedProblem, context: Context) -> None:
    scene = loaded.scene
    conf = context.conf(scene.robot.base, context.home)
    held = context.holding and context.attachment(context.holding)
    poses = {
        name: scene.bodies[name].pose for name in scene.movable if held is None or name != held.body
    }
    if (hit := context.collisions.arrangement(poses, held).hits(conf)) is not None:
        link, other = hit
        outside = {link, other} & set(scene.bodies)
        remedy = "Move its base, or what stands there" if outside else "Give it another 'arm:'"
        raise loaded.error(f"the robot starts in collision: {link} hits {other}", "robot", remedy)
