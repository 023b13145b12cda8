"""After execution a relation of one's own is what its classifier sees, and so it is for planning anew."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

import tamp
from tamp.commands import solve as cli
from tamp.errors import InputError
from tamp.execution.execute import execute
from tamp.execution.execution_options import ExecutionOptions
from tamp.execution.expected import Expected
from tamp.execution.goal import judged
from tamp.execution.observation import ObservedScene, Observer
from tamp.execution.relations import named_classifiers, own_relations
from tamp.geometric.samplers.python_file import python_grounding
from tamp.plan.open import PlanBundle, open_plan
from tamp.symbolic.pddl.parser import parse_domain, parse_goal
from tests.own import PYTHON, SAMPLED, write_domain, write_problem


@pytest.fixture
def folder(root: Path, tmp_path: Path) -> Path:
    write_domain(root, tmp_path, SAMPLED)
    (tmp_path / "upright.py").write_text(PYTHON)
    return tmp_path


def plan_for(folder: Path, goal: str) -> Path:
    problem = tamp.load_problem(
        write_problem(folder, goal), groundings={"upright": python_grounding(folder / "upright.py")}
    )
    return tamp.write_plan(tamp.solve(problem, max_time=60.0, seed=0), folder / "plan.json")


def run(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        cli.execute(list(words))
    said = capsys.readouterr()
    return int(ended.value.code or 0), said.out + said.err


@pytest.mark.parametrize(
    "goal",
    [
        "(not (upright milk table))",
        "(forall (?o - movable) (not (upright ?o shelf)))",
        "(untidy table)",
    ],
)
def test_what_must_not_hold_needs_a_classifier(
    folder: Path, goal: str, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = str(plan_for(folder, goal))
    code, said = run(capsys, plan)
    assert (
        code == 2
        and "does not hold has to be known at the end, and 'upright' has no classifier here" in said
    )
    assert "--sampler upright=FILE" in said
    code, said = run(capsys, plan, "--sampler", f"upright={folder / 'upright.py'}")
    assert code == 0 and "Goal reached: 0 actions" in said, said


def test_what_holds_is_on_trust_without_one(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plan = str(plan_for(folder, "(upright tea table)"))
    code, said = run(capsys, plan)
    assert code == 0 and "Goal reached, on trust: upright: 0 actions" in said
    code, said = run(capsys, plan, "--json")
    assert code == 0 and '"on_trust": [\n  "upright"\n ]' in said
    code, said = run(capsys, plan, "--sampler", f"upright={folder / 'upright.py'}")
    assert code == 0 and "Goal reached: 0 actions" in said
    assert "(upright tea table) holds   upright.py says 1.00" in said


def seen(stored: PlanBundle, poses: dict[str, np.ndarray]) -> ObservedScene:
    scene = stored.loaded.scene
    there = {name: poses.get(name, scene.bodies[name].pose.matrix) for name in scene.movable}
    with Observer(scene) as observer:
        return observer.observe(there, np.array([0.0, 0.0, 0.0]), None)


@pytest.mark.parametrize(
    ("goal", "holds"),
    [
        ("(upright tea table)", (True, False)),
        ("(not (upright tea table))", (False, True)),
        ("(forall (?o - movable) (imply (on ?o table) (not (upright ?o table))))", (False, True)),
        ("(untidy table)", (True, True)),
    ],
)
def test_the_goal_is_what_is_seen(folder: Path, goal: str, holds: tuple[bool, bool]) -> None:
    """The tea stands on the table; then it lies there, a decimetre from where the plan has it."""
    stored = open_plan(plan_for(folder, "(upright tea table)"))
    file = folder / "mine.pddl"
    domain = parse_domain(file.read_text(), file)
    expected = Expected(stored.plan, domain, stored.loaded.scene)
    wanted = parse_goal(goal, domain, expected.semantics.objects)
    own = own_relations(
        stored, domain, wanted, {"upright": ("mine", python_grounding(folder / "upright.py"))}
    )  # type: ignore[dict-item]
    T = stored.loaded.scene.bodies["Tea"].pose.matrix.copy()
    assert not own.missed(seen(stored, {}), None, expected)
    T[:3, :3] = T[:3, :3] @ np.array([[1.0, 0, 0], [0, 0, -1], [0, 1, 0]])
    T[2, 3] -= 0.075 - 0.03
    T[1, 3] += 0.1
    for poses, outcome in (({}, holds[0]), ({"Tea": T}, holds[1])):
        (part,) = judged(wanted, expected, seen(stored, poses), {}, {}, own)
        assert part.holds is outcome, part
    assert own.missed(seen(stored, {"Tea": T}), None, expected) == {("upright", "tea", "table")}


def test_what_moved_and_still_holds_holds(folder: Path) -> None:
    """Half a metre from where the plan put it, the tea stands on the table all the same."""
    stored = open_plan(plan_for(folder, "(upright tea table)"))
    domain = parse_domain((folder / "mine.pddl").read_text())
    expected = Expected(stored.plan, domain, stored.loaded.scene)
    goal = parse_goal("(upright tea table)", domain, expected.semantics.objects)
    upright = python_grounding(folder / "upright.py")
    T = stored.loaded.scene.bodies["Tea"].pose.matrix.copy()
    T[1, 3] -= 0.3
    for classifiers, holds in (({}, False), ({"upright": ("mine", upright)}, True)):
        own = own_relations(stored, domain, goal, classifiers)  # type: ignore[arg-type]
        (part,) = judged(goal, expected, seen(stored, {"Tea": T}), {}, {}, own)
        assert part.holds is holds
        assert holds or part.why == "tea is not where the plan put it"


class Never:
    """Says of nothing that it is upright, once the milk has left the table."""

    def __init__(self, grounding: object) -> None:
        self.grounding = grounding

    def classify(self, scene: tamp.Scene, arguments: object) -> float:
        return 0.0


def test_what_should_hold_and_does_not_is_a_deviation(folder: Path) -> None:
    stored = open_plan(plan_for(folder, "(upright milk shelf)"))
    own = {"upright": ("never", Never(None))}
    done = execute(stored, ExecutionOptions(grasp="constraint", own=own))
    assert not done.reached and done.goal[0].probability == 0.0
    assert "(upright milk shelf) does not hold" in {
        one.message for one in done.actions[-1].deviations
    }


@pytest.mark.slow
def test_planning_anew_starts_from_what_is_seen(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Pushed on its way, the tea stands where it stood: whatever is planned anew ends as the classifier wants it."""
    plan = str(plan_for(folder, "(and (upright milk shelf) (upright tea table))"))
    words = ["--grasp", "constraint", "--replan", "--disturb", "object-moved"]
    sampler = ["--sampler", f"upright={folder / 'upright.py'}"]
    for seed in ("0", "1"):
        code, said = run(capsys, plan, *words, *sampler, "--seed", seed)
        assert code == 0 and "Goal reached:" in said, said


def test_a_scene_that_is_seen_is_asked_about(folder: Path) -> None:
    """The planner's initial facts are those of the scene that it is given: the tea that fell does not stand."""
    path = write_problem(folder, "(upright tea table)")
    upright = python_grounding(folder / "upright.py")
    start = tamp.load_problem(path, groundings={"upright": upright})
    body = start.scene.bodies["Tea"]
    x, y, z = body.pose.position
    fallen = replace(
        body, pose=tamp.Pose((x, y, z - 0.045), (np.sin(np.pi / 4), 0.0, 0.0, np.cos(np.pi / 4)))
    )
    scene = replace(start.scene, bodies=MappingProxyType({**start.scene.bodies, "Tea": fallen}))
    later = tamp.load_problem(path, groundings={"upright": upright}, scene=scene)
    assert ("stood", "tea", "tea_start", "table") in start.stream_task.task.initial
    assert not any(fact[0] == "stood" for fact in later.stream_task.task.initial)


def named(planned: dict[str, str], said: dict[str, str], **objects: object) -> dict[str, Any]:
    """The classifiers of a plan with these samplers, when these are said on the command line."""
    stored: Any = SimpleNamespace(document={"options": {"samplers": planned}})
    registry: Any = {"upright": {"mine": lambda: Never(None), "proposes": object}}
    files = {"tidy": "folder/tidy.py"}
    return dict(named_classifiers(stored, said, objects, registry, files))  # type: ignore[arg-type]


def test_classifiers_are_those_that_the_plan_or_the_command_line_names() -> None:
    assert {name: called for name, (called, _) in named({"upright": "mine"}, {}).items()} == {
        "upright": "mine"
    }
    assert named({"upright": "proposes"}, {}) == {}  # it classifies nothing
    assert named({"on": "surface", "upright": "given"}, {}) == {}
    never = Never(None)
    assert named({}, {}, tidy=never, upright=never, on=never) == {
        "tidy": ("tidy.py", never),
        "upright": ("Never", never),
    }


def test_what_the_plan_names_and_is_gone_is_left_out_but_not_what_was_just_said() -> None:
    assert named({"upright": "gone"}, {}) == {}
    with pytest.raises(InputError, match=r"unknown sampler 'gone'"):
        named({"upright": "mine"}, {"upright": "gone"})
