"""A grounding as the planner calls it: poses and placements out, a probability within its bounds."""

from __future__ import annotations

import numpy as np
import pytest

from grounding.relation_scene import RelationScene
from grounding.runtime import Grounding, Proposer, laid
from tamp.geometric.scene.pose import Array, Pose
from tamp.geometric.stability.placement import Placement
from tamp.geometric.stability.stable_poses import stable_faces_of
from tests.grounding.forms import with_brick


def test_a_pose_near_the_region_becomes_a_placement_on_its_face() -> None:
    made = with_brick()
    faces = stable_faces_of(made.bodies["brick"])
    rotation, pose = faces.ways[0].rotation, made.bodies["brick"].pose
    found = laid(made, ("brick", "table"), rotation, pose.matrix)
    assert isinstance(found, Placement) and (found.region, found.face) == ("table", 0)
    assert (found.x, found.y) == pytest.approx((0.2, 0.1))
    high = Pose((0.2, 0.1, 2.0))
    assert laid(made, ("brick", "table"), rotation, high.matrix) == high
    assert laid(
        made, ("brick", "table"), np.eye(3)[[1, 2, 0]] * 0.5, pose.matrix
    ) == Pose.from_matrix(pose.matrix)


class Says:
    """A model that says one number, and proposes where the body is, so many metres higher each time."""

    def __init__(self, likely: float) -> None:
        self.likely, self.asked = likely, list[Array]()

    def classify(self, situation: RelationScene, poses: Array) -> Array:
        self.asked.append(poses)
        return np.full(len(poses), self.likely)

    def propose(self, situation: RelationScene, count: int, rng: np.random.Generator) -> Array:
        poses = np.tile(situation.body.matrix, (count, 1, 1))
        poses[:, 2, 3] += np.arange(count)
        return poses


@pytest.mark.parametrize(
    ("likely", "said"), [(0.3, 0.3), (0.0, 0.0), (1.0, 1.0), (1.2, 1.0), (-0.1, 0.0)]
)
def test_a_probability_is_one_of_where_the_body_is(likely: float, said: float) -> None:
    made, model = with_brick(), Says(likely)
    assert Grounding(model).classify(made, ("brick", "table")) == said
    (asked,) = model.asked
    assert asked == pytest.approx(made.bodies["brick"].pose.matrix[None])


def test_what_it_proposes_are_poses_in_the_models_order(rng: np.random.Generator) -> None:
    made = with_brick()
    found = Grounding(Says(1.0)).propose(made, ("brick", "table"), 3, rng)
    x, y, z = made.bodies["brick"].pose.position
    assert [pose.position for pose in found if isinstance(pose, Pose)] == [
        (x, y, z),
        (x, y, z + 1.0),
        (x, y, z + 2.0),
    ]
    assert Grounding(Says(1.0)).propose(made, ("brick", "table"), 0, rng) == []


def test_who_cannot_tell_proposes_the_same_and_has_no_classifier(rng: np.random.Generator) -> None:
    made, grounding = with_brick(), Grounding(Says(1.0))
    proposer = Proposer(grounding, "20 labels")
    assert proposer.propose(made, ("brick", "table"), 2, rng) == grounding.propose(
        made, ("brick", "table"), 2, rng
    )
    assert proposer.cannot_tell == "20 labels" and not hasattr(proposer, "classify")
