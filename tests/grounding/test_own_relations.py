"""Relations of one's own: demonstrations in problem files, groundings learned from them or written, the planner."""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

import tamp
from grounding.cli import DONE, run
from grounding.collect import collect, read_demonstrations
from grounding.registry import load_grounding
from grounding.train import train
from grounding.weights import write_weights
from tamp.commands import solve as cli
from tamp.geometric.samplers.python_file import python_grounding
from tamp.geometric.scene.pose import Pose
from tamp.geometric.stability.placement import placed_pose
from tamp.verification.verify import verify


@pytest.fixture
def kitchen(root: Path) -> Path:
    return root / "examples/kitchen"


def test_what_lies_is_learned_from_a_dozen_demonstrations(kitchen: Path, tmp_path: Path) -> None:
    """The milk stands at the start, and `on` would mostly leave it so; every proposal lays it down."""
    weights = tmp_path / "lying.safetensors"
    write_weights(
        weights,
        train(collect("lying", read_demonstrations("lying", [kitchen / "lying"])), "transfer"),
    )
    lying = load_grounding(weights)
    problem = tamp.load_problem(
        kitchen / "kitchen.yaml",
        groundings={"lying": lying, "near": python_grounding(kitchen / "near.py")},
    )
    poses = lying.propose(problem.scene, ("milk", "sideboard"), 16, np.random.default_rng(0))
    faces = problem.context.stable_faces("milk")
    T_world_region = problem.scene.world_pose(problem.scene.region("sideboard"))
    placed = [
        one if isinstance(one, Pose) else placed_pose(faces, one, T_world_region) for one in poses
    ]
    assert len(placed) == 16 and all(abs(pose.matrix[2, 2]) < 0.05 for pose in placed)


def test_both_from_the_command_line(
    kitchen: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["collect", "lying", str(kitchen / "lying")]) == DONE
    assert (
        "data/lying_train.npz written: 14 scenes, {'holds': 12, 'does not hold': 2}"
        in capsys.readouterr().out
    )
    assert run(["train", "lying"]) == DONE
    line = [str(kitchen / "kitchen.pddl"), str(kitchen / "kitchen.yaml"), "--time", "30", "--quiet"]
    assert (
        cli.run([*line, "--sampler", "lying=weights/lying_transfer.safetensors"]) == cli.BAD_INPUT
    )
    assert "Give 'near' a grounding: --sampler near=FILE" in capsys.readouterr().err
    line += [
        "--sampler",
        "lying=weights/lying_transfer.safetensors",
        "--sampler",
        f"near={kitchen / 'near.py'}",
    ]
    assert cli.run(line) == cli.SOLVED, capsys.readouterr()
    assert verify(json.loads(Path("plan.json").read_text())).holds


def executed(line: str, capsys: pytest.CaptureFixture[str]) -> tuple[int, str]:
    """What tamp-execute returns and prints."""
    capsys.readouterr()
    with pytest.raises(SystemExit) as ended:
        cli.execute(line.split())
    said = capsys.readouterr()
    return int(ended.value.code or 0), said.out + said.err


def test_execution_and_planning_anew(
    kitchen: Path,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A relation of one's own holds where the plan put its bodies, and no longer when they are pushed away."""
    monkeypatch.chdir(tmp_path)
    for line in (f"collect lying {kitchen / 'lying'}", "train lying"):
        assert run(line.split()) == DONE
    samplers = (
        f"--sampler lying=weights/lying_transfer.safetensors --sampler near={kitchen / 'near.py'}"
    )
    solve = f"{kitchen / 'kitchen.pddl'} {kitchen / 'kitchen.yaml'} --time 30 --quiet {samplers}"
    assert cli.run(solve.split()) == cli.SOLVED
    code, said = executed("plan.json --grasp constraint", capsys)
    assert (
        code == 0 and "(lying milk sideboard) holds" in said and "(near can mug) holds" in said
    ), said
    code, said = executed("plan.json --grasp constraint --disturb object-moved", capsys)
    assert (
        code == 1
        and "(lying milk sideboard) does not hold: milk is not where the plan put it" in said
    ), said
    code, said = executed("plan.json --replan", capsys)
    assert (
        code == 2
        and "'near' needs the object in Python" in said
        and "--sampler near=FILE.py" in said
    )
    again = f"plan.json --grasp constraint --disturb object-moved --replan --sampler near={kitchen / 'near.py'}"
    code, said = executed(again, capsys)
    assert code == 0 and "Goal reached" in said, said


class Watched:
    """A grounding that keeps where it saw the second body."""

    def __init__(self, path: Path) -> None:
        self.grounding, self.seen = python_grounding(path), set[tuple[float, ...]]()

    def classify(self, scene: tamp.Scene, arguments: Sequence[str]) -> float:
        return self.grounding.classify(scene, arguments)  # type: ignore[union-attr]

    def propose(
        self, scene: tamp.Scene, arguments: Sequence[str], count: int, rng: np.random.Generator
    ) -> list[tamp.Pose]:
        self.seen.add(scene.bodies[arguments[1]].pose.position)
        return self.grounding.propose(scene, arguments, count, rng)  # type: ignore[union-attr]


def test_a_generator_sees_the_pose_that_the_stream_names(kitchen: Path, tmp_path: Path) -> None:
    """The mug has to move, and the can to stand near where the mug will be: the generator is shown it there."""
    text = (kitchen / "kitchen.yaml").read_text().replace("domain: kitchen.pddl\n", "")
    text = text.replace("on: sideboard, at: [0.2, -0.1]", "on: table, at: [0.0, 0.2]")
    text = re.sub(r"goal: .*", "goal: (and (on mug sideboard) (near can mug))", text)
    (tmp_path / "moved.yaml").write_text(text)
    near = Watched(kitchen / "near.py")
    problem = tamp.load_problem(
        tmp_path / "moved.yaml", kitchen / "kitchen.pddl", groundings={"near": near, "lying": near}
    )
    solution = tamp.solve(problem, max_time=30.0, seed=0)
    assert solution.outcome is tamp.Outcome.SOLVED
    assert any(x < 0.0 for x, _, _ in near.seen)  # on the sideboard; the table is at x > 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (None, "no such file"),
        ("grounding = ", "mine.py:1: it cannot be run: SyntaxError"),
        (
            "import nothing_there",
            "it cannot be run: ModuleNotFoundError: No module named 'nothing_there'",
        ),
        ("x = 1", "it defines no 'grounding'"),
        ("grounding = 1", "'grounding' has neither propose nor classify"),
        ("class grounding:\n    def propose(self): ...", "'grounding' is a class, not an object"),
    ],
)
def test_what_is_wrong_with_a_python_file(text: str | None, message: str, tmp_path: Path) -> None:
    path = tmp_path / "mine.py"
    if text is not None:
        path.write_text(text)
    with pytest.raises(tamp.InputError, match=re.escape(message)):
        python_grounding(path)


def test_only_the_command_line_runs_python_files(kitchen: Path, tmp_path: Path, root: Path) -> None:
    text = (root / "problems/one_object.yaml").read_text()
    (tmp_path / "mine.yaml").write_text(f"{text}\nsamplers: {{on: mine.py}}\n")
    (tmp_path / "mine.py").write_text("raise SystemExit")
    with pytest.raises(tamp.InputError, match=r"unknown sampler 'mine\.py'"):
        tamp.load_problem(tmp_path / "mine.yaml", registry=cli.registry())
