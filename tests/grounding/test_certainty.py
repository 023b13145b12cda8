"""A learned classifier says that it cannot tell, rather than what it does not know; one that knows decides."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import tamp
from grounding.certainty import cannot_tell, chance, no_better_than_chance, too_few
from grounding.cli import DONE, run
from grounding.collect import Demonstration, collect
from grounding.dataset import Dataset, write_dataset
from grounding.registry import file_grounding
from grounding.runtime import Grounding, Proposer
from grounding.train import TrainArgs, train
from grounding.weights import write_weights
from tamp.commands import solve as cli
from tamp.commands.verify import main as judge
from tamp.verification.verify import verify
from tests.own import SAMPLED, TESTED, write_domain, write_problem

Made = Callable[[int, Callable[[bool], bool]], Dataset]


@pytest.fixture
def made(root: Path, tmp_path: Path) -> Made:
    """Labelled scenes in which the milk stands or lies, on the table or on the shelf."""

    class Proposing:
        def propose(
            self, scene: object, arguments: object, count: int, rng: object
        ) -> list[tamp.Pose]:
            return []

    path = write_problem(tmp_path, "(upright milk shelf)")
    write_domain(root, tmp_path, SAMPLED, actions="")
    scene = tamp.load_problem(path, groundings={"upright": Proposing()}).scene

    def make(count: int, label: Callable[[bool], bool]) -> Dataset:
        rng = np.random.default_rng(0)
        shown: list[Demonstration] = []
        for number in range(count):
            stands, place = bool(number % 2), ("table", "shelf")[number // 2 % 2]
            surface = scene.surfaces[place]
            x, y = rng.uniform(-0.25, 0.25), rng.uniform(-0.1, 0.1)
            yaw = rng.uniform(-np.pi, np.pi)
            turn = tamp.Pose((0, 0, 0), (0, 0, np.sin(yaw / 2), np.cos(yaw / 2)))
            lie = tamp.Pose(
                (0, 0, 0), (0, 0, 0, 1) if stands else (np.sqrt(0.5), 0, 0, np.sqrt(0.5))
            )
            height = 0.1 if stands else 0.035
            pose = scene.world_pose(surface) @ tamp.Pose((x, y, height + 0.001)) @ turn @ lie
            milk = replace(scene.bodies["milk"], pose=pose)
            there = replace(scene, bodies={**scene.bodies, "milk": milk})
            shown.append(Demonstration(there, ("milk", place), label(stands)))
        return collect("upright", shown)

    return make


def test_too_few_labels_or_kinds() -> None:
    assert too_few(np.array([True, False] * 50)) is None
    assert "20 labels, 10 of them negative" in str(too_few(np.array([True, False] * 10)))
    assert "120 labels, none of them negative" in str(too_few(np.ones(120, dtype=bool)))
    assert "120 labels, 2 of them positive" in str(too_few(np.arange(120) < 2))


def test_chance_is_told_from_knowledge() -> None:
    holds, rng = np.arange(200) % 2 == 0, np.random.default_rng(0)
    assert chance(holds, holds) is None
    assert chance(holds, np.ones(200, dtype=bool)) == "it says yes to everything"
    assert chance(holds, np.zeros(200, dtype=bool)) == "it says no to everything"
    guesses = [chance(holds, rng.random(200) < 0.5) is None for _ in range(400)]
    assert np.mean(guesses) < 0.06  # two standard errors
    rare = np.arange(200) < 20
    assert (
        chance(rare, rng.random(200) < 0.1) is not None
    )  # right about 82 %, as saying no always is about 90 %
    shown: list[int] = []

    def fit(train_rows: np.ndarray, test_rows: np.ndarray) -> np.ndarray:
        assert not {*train_rows} & {*test_rows}
        shown.extend(test_rows)
        return holds[test_rows]

    assert no_better_than_chance(holds, fit) is None and sorted(shown) == list(range(200))


@pytest.mark.parametrize(
    ("count", "kind", "why"),
    [
        (20, "stands", "it was trained on 20 labels, 10 of them negative; a classifier needs 100"),
        (120, "all", "none of them negative"),
        pytest.param(120, "chance", "it is no better than chance", marks=pytest.mark.slow),
        (120, "stands", None),
    ],
)
def test_what_does_not_know_does_not_classify(
    count: int, kind: str, why: str | None, made: Made, tmp_path: Path
) -> None:
    rng = np.random.default_rng(1)
    labels = {
        "stands": lambda stands: stands,
        "all": lambda stands: True,
        "chance": lambda stands: rng.random() < 0.5,
    }
    weights = train(made(count, labels[kind]), "transfer")
    assert (
        (cannot_tell(weights.card) or "") == ""
        if why is None
        else why in str(cannot_tell(weights.card))
    )
    write_weights(tmp_path / "upright.safetensors", weights)
    grounding = file_grounding("upright", tmp_path / "upright.safetensors")
    if why is None:
        assert isinstance(grounding, Grounding)
    else:
        assert isinstance(grounding, Proposer) and why in grounding.cannot_tell


def test_a_tree_is_held_to_the_same(made: Made) -> None:
    rng = np.random.default_rng(1)
    assert cannot_tell(train(made(120, lambda stands: stands), "tree-bb").card) is None
    assert "chance" in str(
        cannot_tell(train(made(120, lambda stands: rng.random() < 0.5), "tree-bb").card)
    )
    assert "30 labels" in str(
        cannot_tell(train(made(30, lambda stands: stands), "tree-bb", TrainArgs(samples=30)).card)
    )


def test_training_says_so_and_the_planner_refuses(
    root: Path,
    made: Made,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    write_dataset(tmp_path / "data.npz", made(20, lambda stands: stands))
    assert run(["train", "upright", "--data", "data.npz", "--out", "upright.safetensors"]) == DONE
    said = capsys.readouterr().err
    assert (
        "warning: it only proposes, and cannot tell yet where 'upright' holds: it was trained on 20 labels"
        in said
    )

    write_domain(root, tmp_path, TESTED)
    write_problem(tmp_path, "(upright milk table)")
    line = ["mine.yaml", "--sampler", "upright=upright.safetensors", "--quiet"]
    assert cli.run(line) == cli.BAD_INPUT
    said = capsys.readouterr().err
    assert "mine.streams.pddl:" in said and "stream 'test-upright' needs a classifier" in said
    assert "cannot tell yet: it was trained on 20 labels" in said

    write_domain(root, tmp_path, SAMPLED, actions="")
    assert cli.run(line) == cli.SOLVED
    assert judge(["plan.json"]) == 0 and "holds, on trust: upright" in capsys.readouterr().out
    assert judge(["plan.json", "--sampler", "upright=upright.safetensors"]) == 2
    assert (
        "the classifier of 'upright' cannot tell yet: it was trained on 20"
        in capsys.readouterr().err
    )
    write_problem(tmp_path, "(not (upright milk table))")
    assert cli.run(line) == cli.BAD_INPUT
    assert (
        "'upright' is unknown until a plan makes it true: its classifier cannot tell yet"
        in capsys.readouterr().err
    )


def test_a_learned_classifier_decides_everywhere(root: Path, made: Made, tmp_path: Path) -> None:
    """As the one in Python does: at the start, under `not`, in a precondition, in a rule, for the judge."""
    weights = tmp_path / "upright.safetensors"
    write_weights(weights, train(made(240, lambda stands: stands), "transfer"))
    write_domain(root, tmp_path, TESTED)
    learned = file_grounding("upright", weights)
    assert isinstance(learned, Grounding)
    for goal, actions in (
        ("(not (upright milk table))", []),
        ("(mopped milk)", ["mop"]),
        ("(untidy table)", []),
        ("(upright milk shelf)", ["move", "pick", "move", "place"]),
    ):
        problem = tamp.load_problem(
            write_problem(tmp_path, goal),
            samplers={"upright": str(weights)},
            registry=cli.registry(),
        )
        assert {*problem.classifiers} == {"upright"}
        solution = tamp.solve(problem, max_time=60.0, seed=0)
        assert [action.name for action in solution.plan] == actions, (goal, solution.explanation)
        plan = tamp.write_plan(solution, tmp_path / "plan.json")
        report = verify(plan, classifiers={"upright": learned})
        assert report.holds and report.checked, (goal, report.text())
        assert verify(plan).on_trust == ("upright",)
