"""What the page can ask for, and what any program may send instead."""

from __future__ import annotations

import json
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from grounding.demonstrate.runner import Runner
from grounding.demonstrate.studio import Studio
from grounding.relations.demonstration_file import demonstrations_of
from tamp.errors import InputError
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose

Maker = Callable[..., Studio]


def numbers(pose: Pose) -> list[float]:
    return pose.matrix.ravel().tolist()


def about(studio: Studio, poses: dict[str, Pose] | None = None, **more: Any) -> dict[str, Any]:
    """What the page sends of the scene that it shows."""
    shown = {name: numbers(pose) for name, pose in (poses or {}).items()}
    return {"stage": studio.state()["stage"]["number"], "poses": shown, **more}


def on_top(studio: Studio) -> dict[str, Pose]:
    """The first argument above the second one."""
    a, b = (studio.stage.scene.bodies[name] for name in studio.stage.arguments)
    top = float(bounds(b.parts, b.pose)[1][2])
    return {a.name: Pose((b.pose.position[0], b.pose.position[1], top + 0.3), a.pose.quaternion)}


def test_a_demonstration_from_drag_to_file(studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    poses = on_top(studio)
    name = studio.stage.arguments[0]
    said = studio.act("put_down", about(studio, poses, body=name))
    poses = {name: Pose.from_matrix(np.array(said["T"]).reshape(4, 4))}
    said = studio.act("label", about(studio, poses, holds=True, anyway=True, next=True))
    assert said["saved"] == "stack_001.yaml" and (said["holding"], said["other"]) == (1, 0)
    assert said["stage"]["number"] == 1  # the next scene
    (found,) = demonstrations_of("stack", [studio.folder.path])
    assert found.holds
    assert found.scene.bodies[name].pose.matrix == pytest.approx(poses[name].matrix, abs=1e-5)


def test_what_is_odd_is_asked_about_first(studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    poses = on_top(studio)
    said = studio.act("label", about(studio, poses, holds=True))
    assert " hangs " in said["odd"][0] and studio.folder.cards() == []
    assert "saved" in studio.act(
        "label", about(studio, poses, holds=False)
    )  # what hangs may well be none
    said = studio.act("label", about(studio, poses, holds=True, anyway=True))
    assert [hint["kind"] for hint in said["hints"]] == ["contradiction"]
    said = studio.act("label", about(studio, {}, holds=True))
    assert "saved" in said
    assert (
        "shows the same and says the opposite"
        in studio.act("label", about(studio, {}, holds=False))["odd"][0]
    )


def test_the_state_is_json_and_whole(studio_of: Maker) -> None:
    studio = studio_of("within(a, b: container)")
    state = json.loads(json.dumps(studio.state(), allow_nan=False))
    assert state["commands"]["learn"].startswith("tamp-learn new within --demos ")
    assert state["stage"]["arguments"] == list(studio.stage.arguments)
    bodies = {body["name"]: body for body in state["stage"]["bodies"]}
    assert (
        bodies[studio.stage.arguments[1]]["movable"] and bodies[studio.stage.arguments[0]]["faces"]
    )
    assert all(mesh["faces"] for body in bodies.values() for mesh in body["meshes"])


def test_another_relation_has_a_folder_of_its_own(
    tmp_path: Path, workbench, runner, monkeypatch
) -> None:
    from grounding.demonstrate.folder import SceneSource
    from grounding.demonstrate.relation import parse_relation

    monkeypatch.chdir(tmp_path)
    studio = Studio(parse_relation("stack(a, b)"), SceneSource(), workbench, runner)
    studio.act("label", about(studio, holds=False, anyway=True))
    said = studio.act("relation", {"text": "between(a, b, c)"})
    assert (
        said["folder"] == "demos/between"
        and len(said["stage"]["arguments"]) == 3
        and said["cards"] == []
    )
    assert studio.act("relation", {"text": "stack(a, b)"})["other"] == 1
    with pytest.raises(InputError, match="has 2 arguments here"):
        studio.act("relation", {"text": "stack(a, b, c)"})
    assert studio.state()["relation"]["text"] == "stack(a, b)"


def test_a_folder_that_was_named_is_for_one_relation(studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    assert studio.act("relation", {"text": "near(a, b)"})["relation"]["name"] == "near"
    studio.act("label", about(studio, holds=False, anyway=True))
    with pytest.raises(InputError, match="has demonstrations of near"):
        studio.act("relation", {"text": "stack(a, b)"})


def test_the_front_is_kept_in_what_is_labelled(studio_of: Maker) -> None:
    studio = studio_of("left_of(a, b)")
    name = studio.stage.arguments[0]
    table = studio.stage.scene.bodies[next(iter(studio.stage.scene.bodies))]
    moved = {name: Pose((table.pose.position[0], table.pose.position[1], 1.8))}
    said = studio.act("front", about(studio, moved, yaw=table.pose.yaw + 0.2))  # its +x side
    assert said["stage"]["number"] == 1
    eye = said["stage"]["view"]["yaw"]
    assert np.cos(eye - table.pose.yaw) == pytest.approx(1.0)
    studio.act("label", about(studio, moved, holds=False, anyway=True))
    (found,) = demonstrations_of("left_of", [studio.folder.path])
    assert found.scene.bodies[table.name].front == pytest.approx(np.pi / 2)
    assert found.scene.bodies[name].pose.position == pytest.approx(moved[name].position)

    for bad in (None, "left", True, float("nan"), float("inf")):
        with pytest.raises(InputError, match="'yaw' is no finite number"):
            studio.act("front", about(studio, yaw=bad))


def test_arguments_are_chosen_among_what_is_there(studio_of: Maker, root: Path) -> None:
    studio = studio_of("near(a, b)", root / "problems/four_objects.yaml")
    moved = {"cracker_box": Pose((1.5, 0.0, 1.5))}
    said = studio.act("assign", about(studio, moved, argument=0, name="mug"))
    assert said["stage"]["arguments"] == ["mug", "soup_can"]
    assert studio.stage.scene.bodies["cracker_box"].pose.position == pytest.approx((1.5, 0.0, 1.5))
    said = studio.act("assign", about(studio, argument=0, name="soup_can"))
    assert said["stage"]["arguments"] == ["soup_can", "mug"]  # they change places
    assert studio.act("next", {})["stage"]["arguments"] == ["soup_can", "mug"]
    for argument, name in ((2, "mug"), (-1, "mug"), ("a", "mug"), (0, "nothing")):
        with pytest.raises(InputError):
            studio.act("assign", about(studio, argument=argument, name=name))


def test_a_demonstration_is_taken_up_again(studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    poses = on_top(studio)
    studio.act("label", about(studio, poses, holds=False, next=True))
    said = studio.act("open", {"name": "stack_001.yaml"})
    name = said["stage"]["arguments"][0]
    (body,) = [one for one in said["stage"]["bodies"] if one["name"] == name]
    assert body["T"] == pytest.approx(numbers(poses[name]), abs=1e-5)
    said = studio.act(
        "label", about(studio, {name: Pose((0.0, 0.0, 1.0))}, holds=False, anyway=True)
    )
    assert said["saved"] == "stack_002.yaml" and said["other"] == 2


def test_pictures(studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    studio.act("label", about(studio, holds=False, anyway=True))
    content = studio.picture("stack_001.yaml")
    assert content is not None and content.startswith(b"\x89PNG")
    assert studio.picture("../stack_001.yaml") is None


@pytest.mark.parametrize(
    ("action", "message", "says"),
    [
        ("nothing", {}, "unknown action"),
        ("put_down", {}, "another scene"),
        ("put_down", {"stage": 0}, "poses are missing"),
        ("put_down", {"stage": 0, "poses": {}}, "'body' is missing"),
        ("put_down", {"stage": 0, "poses": {}, "body": "table"}, "cannot be moved"),
        ("check", {"stage": 0, "poses": {"table": [0.0] * 16}}, "cannot be moved"),
        ("check", {"stage": 7, "poses": {}}, "another scene"),
        ("label", {"stage": 0, "poses": {}}, "true or false"),
        ("label", {"stage": 0, "poses": {}, "holds": "yes"}, "true or false"),
        ("learn", {}, "nothing has been demonstrated yet"),
        ("delete", {}, "'name' is missing"),
        ("delete", {"name": "../x.yaml"}, "there is no demonstration"),
        ("open", {"name": "x.yaml"}, "there is no demonstration"),
        ("relation", {"text": "and(a)"}, "is taken"),
        ("relation", {"text": 7}, "'text' is missing"),
    ],
)
def test_what_cannot_be_done_is_said(
    action: str, message: dict[str, Any], says: str, studio_of: Maker
) -> None:
    with pytest.raises(InputError, match=says):
        studio_of("stack(a, b)").act(action, message)


@pytest.mark.parametrize(
    "pose",
    [
        None, 3, [1.0] * 15, [1.0] * 16, [float("nan")] * 16, ["a"] * 16, [True] * 16, [0.0] * 16,
        [1, 0, 0, 99.0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1],
    ],
)  # fmt: skip
def test_what_is_no_pose_is_refused(pose: Any, studio_of: Maker) -> None:
    studio = studio_of("stack(a, b)")
    with pytest.raises(InputError):
        studio.act("check", {"stage": 0, "poses": {studio.stage.arguments[0]: pose}})


values = st.recursive(
    st.none() | st.booleans() | st.floats(allow_nan=False) | st.integers() | st.text(max_size=20)
    | st.sampled_from(["stack_001.yaml", "red_box", "stack(a, b)", "a", "b"]),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4),
    max_leaves=8,
)  # fmt: skip
messages = st.fixed_dictionaries(
    {},
    optional={
        key: values
        for key in ("stage", "poses", "body", "holds", "name", "text", "argument", "anyway", "next")
    },
)
ACTIONS = (
    "relation",
    "assign",
    "next",
    "open",
    "put_down",
    "drop",
    "check",
    "label",
    "delete",
    "restore",
    "flip",
)


@settings(max_examples=150, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(action=st.sampled_from(ACTIONS), message=messages)
def test_anything_else_is_an_error_in_words(
    action: str, message: dict[str, Any], studio_of: Maker
) -> None:
    studio = _kept.setdefault("studio", studio_of("stack(a, b)"))
    try:
        answer = studio.act(action, message)
    except InputError:
        return
    json.dumps(answer, allow_nan=False)


_kept: dict[str, Studio] = {}


def test_learned_asked_and_planned(studio_of: Maker, runner: Runner) -> None:
    """Only what the page sends: upright(o) of bodies whose model is upright, learned, asked about, planned."""
    studio = studio_of("upright(o: box)", seed=1)
    for action in ("ask", "plan"):
        with pytest.raises(InputError, match="has not been learned yet"):
            studio.act(action, about(studio))
    for number in range(16):
        name, holds = studio.stage.arguments[0], number % 2 == 0
        tilt = (0.0, 0.0, 0.0) if holds else (np.pi / 2 * (-1) ** (number // 2), 0.0, 0.0)
        x, y, z = studio.stage.scene.bodies[name].pose.position
        pose = {name: Pose.from_xyz_rpy((x, y, z + 0.2), (*tilt[:2], float(number)))}
        said = studio.act("put_down", about(studio, pose, body=name))
        pose = {name: Pose.from_matrix(np.array(said["T"]).reshape(4, 4))}
        studio.act("label", about(studio, pose, holds=holds, anyway=True, next=True))

    said = finished(studio, studio.act("learn", {}))
    assert said["code"] == 0 and "what it is:" in said["text"]
    assert studio.state()["learned"] and "red_box" not in said["text"].partition("held out")[0]
    number = studio.state()["stage"]["number"]
    asked = studio.act("ask", {})
    assert asked["asked"] and asked["stage"]["number"] == number + 1
    opinion = studio.act("check", about(studio))["opinion"]
    assert 0.0 <= opinion <= 1.0
    said = studio.act("label", about(studio, holds=opinion >= 0.5, anyway=True, next=True))
    assert said["asked"] and said["saved"] == "upright_017.yaml"  # the next question

    studio.act("next", {})
    said = finished(studio, studio.act("plan", about(studio)))
    assert said["command"] == "tamp-solve" and said["code"] in (0, 1), said["text"]
    assert ("plan.json written" in said["text"]) == (said["code"] == 0)
    assert "domain: ../upright.pddl" in studio.uses.problem.read_text(encoding="utf-8")
    assert len(studio.folder.cards()) == 17  # the problem is none of them


def finished(studio: Studio, said: Any) -> Any:
    while said["running"]:
        time.sleep(0.2)
        said = studio.run_state()
    return said
