"""Scenes to demonstrate in: generated, of a problem file, shuffled, saved and read again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from grounding.demonstrate.relation import PRESETS, parse_relation
from grounding.demonstrate.scene import open_stage, sample_stage, shuffled
from grounding.demonstrate.viewer import viewer_yaw
from grounding.demonstrate.workbench import Workbench
from grounding.relations.demonstration_file import Label, demonstrations_of
from grounding.relations.demonstration_text import write_demonstration
from tamp.errors import InputError
from tamp.geometric.loading.overlaps import find_overlaps
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


@pytest.mark.parametrize(
    "text", [*PRESETS, "set_table(cup, plate, fork)", "pack(box: container, a, b, c)"]
)
def test_generated_scenes_are_sound(text: str, workbench: Workbench) -> None:
    relation = parse_relation(text)
    for seed in range(4):
        stage = sample_stage(relation, np.random.default_rng(seed))
        scene = stage.scene
        assert list(find_overlaps(scene)) == []
        assert list(workbench.troubles(stage.posed({}), stage.movable)) == []
        assert len(stage.arguments) == len(set(stage.arguments)) == len(relation.arguments)
        for argument, name in zip(relation.arguments, stage.arguments, strict=True):
            if argument.kind == "surface":
                assert name in scene.surfaces
            else:
                assert name in stage.movable
                assert (name in scene.cavities) == (argument.kind == "container")


def test_scenes_vary_in_all_that_may_matter() -> None:
    relation, rng = parse_relation("stack(a, b)"), np.random.default_rng(5)
    stages = [sample_stage(relation, rng) for _ in range(12)]
    heights = [
        bounds(s.scene.bodies[s.arguments[1]].parts, s.scene.bodies[s.arguments[1]].pose)[0][2]
        for s in stages
    ]
    yaws = [viewer_yaw(s.scene, s.arguments) for s in stages]
    sizes = [
        np.ptp(bounds(s.scene.bodies[s.arguments[0]].parts, Pose()), axis=0).max() for s in stages
    ]
    assert np.ptp(heights) > 0.4 and np.ptp(yaws) > 3.0 and np.ptp(sizes) > 0.05
    assert len({next(iter(stage.scene.bodies)) for stage in stages}) > 1


def test_the_same_seed_gives_the_same_scenes() -> None:
    relation = parse_relation("between(a, b, c)")
    one, other = (sample_stage(relation, np.random.default_rng(9)) for _ in range(2))
    assert one.entries == other.entries


def test_what_is_saved_is_what_was_shown(tmp_path: Path) -> None:
    stage = sample_stage(parse_relation("within(a, b: container)"), np.random.default_rng(1))
    first = stage.arguments[0]
    moved = stage.moved({first: Pose((0.3, -0.2, 1.7), (0.5, 0.5, 0.5, 0.5))})
    write_demonstration(tmp_path / "one.yaml", moved.file(Label("within", stage.arguments, False)))
    (found,) = demonstrations_of("within", [tmp_path])
    assert found.arguments == stage.arguments and not found.holds
    assert found.scene.bodies[first].pose.matrix == pytest.approx(
        moved.scene.bodies[first].pose.matrix, abs=1e-6
    )
    for name, body in stage.scene.bodies.items():
        if name != first:
            assert found.scene.bodies[name].pose.matrix == pytest.approx(body.pose.matrix, abs=2e-6)


def test_a_problem_file_is_a_scene(root: Path, workbench: Workbench) -> None:
    file, relation = root / "problems/four_objects.yaml", parse_relation("near(a, b)")
    stage = open_stage(file, relation, {})
    assert stage.arguments == ("cracker_box", "soup_can")
    assert open_stage(file, relation, {"a": "mug"}).arguments == ("mug", "cracker_box")
    other = shuffled(stage, np.random.default_rng(0))
    assert list(find_overlaps(other.scene)) == []
    assert list(workbench.troubles(other.posed({}), other.movable)) == []
    gone = [
        np.linalg.norm(
            np.subtract(
                other.scene.bodies[name].pose.position, stage.scene.bodies[name].pose.position
            )
        )
        for name in stage.scene.movable
    ]
    assert np.median(gone) > 0.05


def test_places_of_a_problem_file_are_arguments(root: Path) -> None:
    file = root / "problems/four_objects.yaml"
    stage = open_stage(file, parse_relation("lying(o, s: surface)"), {})
    assert stage.arguments == ("cracker_box", "table")
    stage = open_stage(file, parse_relation("in(o, c: container)"), {"c": "cupboard_2"})
    assert stage.arguments == ("cracker_box", "cupboard_2")


@pytest.mark.parametrize(
    ("text", "chosen", "says"),
    [
        ("near(a, b, c)", {}, "too few bodies"),
        ("near(a)", {"a": "soup"}, "cannot be the argument a"),
        ("in(a, c: container)", {"c": "table"}, "cannot be the argument c"),
    ],
)
def test_a_problem_file_without_what_is_needed(
    text: str, chosen: dict[str, str], says: str, root: Path
) -> None:
    with pytest.raises(InputError, match=says):
        open_stage(root / "problems/one_object.yaml", parse_relation(text), chosen)


def test_a_body_below_the_floor_is_refused() -> None:
    stage = sample_stage(parse_relation("upright(o)"), np.random.default_rng(0))
    with pytest.raises(InputError, match="below the floor"):
        stage.moved({stage.arguments[0]: Pose((0.0, 0.0, -0.2))})
