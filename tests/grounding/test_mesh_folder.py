"""A folder of one's own meshes: every format joins, what is odd is warned of, what is wrong is one clear line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from grounding.cli import BAD_INPUT, DONE, run
from grounding.generate import Job, generate
from grounding.mesh_folder import MeshFolder, read_folder
from tamp.errors import InputError
from tamp.geometric.scene.bounds import bounds
from tamp.geometric.scene.pose import Pose


def box(size: tuple[float, float, float] = (0.06, 0.08, 0.1)) -> trimesh.Trimesh:
    return trimesh.creation.box(size)


def put(folder: Path, name: str, mesh: trimesh.Trimesh) -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    mesh.export(path)
    return path


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """As YCB comes, and each format once."""
    folder = tmp_path / "ycb"
    put(folder, "003_cracker_box/google_16k/textured.obj", box())
    put(folder, "005_soup_can/nontextured.stl", trimesh.creation.cylinder(0.033, 0.1))
    put(folder, "055_ball/ball.ply", trimesh.creation.icosphere(radius=0.03, subdivisions=1))
    put(folder, "ring.obj", trimesh.creation.annulus(0.03, 0.04, 0.05))
    (folder / "notes.txt").write_text("not a mesh")
    (folder / "empty").mkdir()
    return folder


def test_every_format_joins(folder: Path) -> None:
    loaded = read_folder(MeshFolder(folder))
    assert [*loaded.templates] == ["003_cracker_box", "005_soup_can", "055_ball", "ring"]
    assert loaded.warnings == ()
    low, high = bounds(loaded.templates["003_cracker_box"], Pose())
    assert high - low == pytest.approx([0.06, 0.08, 0.1])
    assert len(loaded.templates["ring"]) > 1  # it has a hole


def test_a_cloud_of_points_beside_the_mesh_is_passed_over(tmp_path: Path) -> None:
    put(tmp_path, "mug/google_16k/nontextured.stl", box())
    cloud = trimesh.PointCloud(np.random.default_rng(0).uniform(size=(20, 3)))
    (tmp_path / "mug/clouds").mkdir()
    cloud.export(tmp_path / "mug/clouds/merged_cloud.ply")
    assert [*read_folder(MeshFolder(tmp_path)).templates] == ["mug"]
    (tmp_path / "mug/google_16k/nontextured.stl").unlink()
    with pytest.raises(InputError, match=r"merged_cloud\.ply.*it holds no triangles"):
        read_folder(MeshFolder(tmp_path / "mug"))


def test_data_are_made_with_it(folder: Path, tmp_path: Path) -> None:
    own = MeshFolder(folder)
    data = generate(Job("on", "train", 4, folder=own), tmp_path / "own.npz", workers=1)
    assert {"003_cracker_box", "ring"} <= {*data.card["objects"]}
    assert json.loads((tmp_path / "own.json").read_text())["objects"][-4:] == [
        *read_folder(own).templates
    ]


def test_a_changed_mesh_makes_another_job(folder: Path) -> None:
    before = Job("on", "train", 4, folder=MeshFolder(folder)).key
    assert before == Job("on", "train", 8, folder=MeshFolder(folder)).key
    assert before != Job("on", "train", 4, folder=MeshFolder(folder, 0.5)).key
    put(folder, "003_cracker_box/google_16k/textured.obj", box((0.05, 0.05, 0.05)))
    assert before != Job("on", "train", 4, folder=MeshFolder(folder)).key


def test_a_mesh_that_is_not_watertight_is_repaired_and_said(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    open_box = box()
    open_box.update_faces(np.arange(len(open_box.faces)) > 1)
    put(folder, "open/open.stl", open_box)
    loaded = read_folder(MeshFolder(folder))
    assert "open" in loaded.templates
    (warning,) = loaded.warnings
    assert "open.stl" in warning and "is not watertight (4 open edges): they were closed" in warning


def test_millimetres_are_seen_and_mended_by_an_option(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    put(tmp_path, "mm/box/box.stl", box((60.0, 80.0, 100.0)))
    line = ["generate", "on", "--count", "2", "--workers", "1", "--meshes", str(tmp_path / "mm")]
    line += ["--out", str(tmp_path / "x.npz")]
    assert run(line) == BAD_INPUT
    said = capsys.readouterr().err
    assert (
        "box.stl: the mesh 'box.stl' is 60 x 80 x 100 m large" in said
        and "say --mesh-scale 0.001" in said
    )
    assert run([*line, "--mesh-scale", "0.001"]) == DONE
    assert json.loads((tmp_path / "x.json").read_text())["objects"][-1] == "box"
    assert run([*line, "--mesh-scale", "0"]) == BAD_INPUT
    assert "--mesh-scale must be positive" in capsys.readouterr().err


def test_what_no_hand_moves_is_left_out_with_a_warning(folder: Path, tmp_path: Path) -> None:
    put(folder, "wardrobe/wardrobe.obj", box((0.8, 0.5, 1.9)))
    loaded = read_folder(MeshFolder(folder))
    assert "wardrobe" not in loaded.templates
    assert (
        "wardrobe.obj: left out, it is 1.9 m large, and not between 0.02 and 0.28 m"
        in loaded.warnings[0]
    )
    put(tmp_path / "large", "wardrobe.obj", box((0.8, 0.5, 1.9)))
    with pytest.raises(InputError, match="none of its meshes can be used"):
        read_folder(MeshFolder(tmp_path / "large"))


def test_what_is_no_mesh_is_one_line(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name, content in {
        "broken.obj": b"v 1 2\nf 1 2 3\n",
        "broken.stl": b"\x00\x01",
        "broken.ply": b"ply\nnonsense",
    }.items():
        place = tmp_path / name.replace(".", "_") / "thing"
        place.mkdir(parents=True)
        (place / name).write_bytes(content)
        assert (
            run(["explore", "on", "--meshes", str(place.parent), "--out", str(tmp_path / "x.npz")])
            == BAD_INPUT
        )
        said = capsys.readouterr().err
        assert said.startswith("error: ") and said.count("\n") == 1 and name in said
    (tmp_path / "nothing").mkdir()
    for place, message in (
        (tmp_path / "nothing", "no meshes in this folder"),
        (tmp_path / "none", "no such folder"),
    ):
        assert (
            run(["generate", "on", "--meshes", str(place), "--out", str(tmp_path / "x.npz")])
            == BAD_INPUT
        )
        assert message in capsys.readouterr().err
