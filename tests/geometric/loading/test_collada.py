"""COLLADA files: unit and nodes' transforms applied, all ways to say triangles read, broken ones refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tamp.errors import InputError
from tamp.geometric.loading.collada import _MOST_INSTANCES, read_collada
from tamp.geometric.loading.mesh_file import read_triangles
from tamp.geometric.loading.meshes import load_mesh

pytestmark = pytest.mark.usefixtures("own_cache")


DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 5 0 0 0 6 0 0 0 7</float_array></source>
  <source id="n"><float_array id="na" count="3">0 0 1</float_array></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  GROUP
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node>
  NODE<instance_geometry url="#g"/>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


INPUTS = '<input semantic="VERTEX" source="#v" offset="0"/><input semantic="NORMAL" source="#n" offset="1"/>'


GROUP = f'<triangles count="4">{INPUTS}<p>0 0 2 0 1 0  0 0 1 0 3 0  1 0 2 0 3 0  0 0 3 0 2 0</p></triangles>'


def test_transforms_beyond_all_numbers_are_refused_without_a_warning(tmp_path: Path) -> None:
    far = "<scale>1e200 1e200 1e200</scale>" * 2
    (tmp_path / "a.dae").write_text(DAE.replace("GROUP", GROUP).replace("NODE", far))
    with pytest.raises(InputError, match="not finite"):
        load_mesh(tmp_path / "a.dae")


@pytest.mark.parametrize(
    ("node", "low", "high"),
    [
        ("", (0, 0, 0), (0.05, 0.06, 0.07)),
        ("<translate>100 0 0</translate>", (1, 0, 0), (1.05, 0.06, 0.07)),
        ("<scale>2 1 1</scale>", (0, 0, 0), (0.1, 0.06, 0.07)),
        ("<rotate>0 0 1 90</rotate>", (-0.06, 0, 0), (0, 0.05, 0.07)),
        ("<matrix>1 0 0 0 0 1 0 0 0 0 -1 10 0 0 0 1</matrix>", (0, 0, 0.03), (0.05, 0.06, 0.1)),
        ("<translate>0 0 10</translate><scale>1 1 2</scale>", (0, 0, 0.1), (0.05, 0.06, 0.24)),
    ],
)
def test_colladas_unit_and_nodes_count(
    tmp_path: Path, node: str, low: tuple[float, ...], high: tuple[float, ...]
) -> None:
    (tmp_path / "a.dae").write_text(DAE.replace("NODE", node).replace("GROUP", GROUP))
    vertices, faces = read_triangles(tmp_path / "a.dae")
    assert vertices.min(axis=0) == pytest.approx(low, abs=1e-12) and vertices.max(
        axis=0
    ) == pytest.approx(high)
    a, b, c = vertices[faces].transpose(1, 0, 2)
    volume = (
        np.einsum(
            "ij,ij->", a - vertices.mean(axis=0), np.cross(b, c) - np.cross(b, a) - np.cross(a, c)
        )
        / 6
    )
    assert volume > 0  # outward, mirrored or not


@pytest.mark.parametrize(
    "group",
    [
        GROUP,
        f'<polylist count="4">{INPUTS}<vcount>3 3 3 3</vcount>'
        + GROUP.partition(INPUTS)[2].replace("triangles", "polylist"),
        f"<polygons>{INPUTS}<p>0 0 2 0 1 0</p><p>0 0 1 0 3 0</p><p>1 0 2 0 3 0</p><p>0 0 3 0 2 0</p></polygons>",
        f"<tristrips>{INPUTS}<p>0 0 2 0 1 0 3 0 0 0 2 0</p></tristrips>",
    ],
)
def test_colladas_ways_to_say_triangles(tmp_path: Path, group: str) -> None:
    (tmp_path / "a.dae").write_text(DAE.replace("NODE", "").replace("GROUP", group))
    vertices, faces = read_collada(tmp_path / "a.dae", 10_000)
    assert len(faces) == 4 and len(vertices) == 4
    assert {tuple(sorted(face)) for face in faces.tolist()} == {
        (0, 1, 2),
        (0, 1, 3),
        (1, 2, 3),
        (0, 2, 3),
    }
    assert load_mesh(tmp_path / "a.dae").parts


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('url="#g"', 'url="#h"', "shows '#h', which it does not hold"),
        ('meter="0.01"', 'meter="0"', "its unit is 0 m"),
        ('meter="0.01"', 'meter="far"', "<unit> is not made of numbers"),
        ("0 0 2 0 1 0 ", "0 0 2 0 9 0 ", "a face names a missing corner"),
        ("0 0 2 0 1 0 ", "0 0 2 0 x 0 ", "not made of whole numbers"),
        ("0 0 0 5 0 0", "0 0 0 five 0 0", "<float_array> is not made of numbers"),
        ("NODE", "<translate>1 2</translate>", "<translate> has 2 numbers, not 3"),
        ("NODE", "<node>" * 200 + "</node>" * 200, "nested too deeply"),
        ("<node>\n", '<node id="me"><instance_node url="#me"/>', "nested too deeply"),
    ],
)
def test_broken_collada(tmp_path: Path, old: str, new: str, message: str) -> None:
    text = DAE.replace("GROUP", GROUP)
    assert text.count(old) == 1
    (tmp_path / "a.dae").write_text(text.replace(old, new).replace("NODE", ""))
    with pytest.raises(InputError, match=message):
        load_mesh(tmp_path / "a.dae")


TETRAHEDRON_M3 = 0.05 * 0.06 * 0.07 / 6


def volume(vertices: np.ndarray, faces: np.ndarray) -> float:
    a, b, c = vertices[faces].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def written(folder: Path, text: str) -> Path:
    file = folder / "a.dae"
    file.write_text(text.replace("NODE", "").replace("GROUP", GROUP))
    return file


def test_without_a_scene_all_geometries_are_shown(tmp_path: Path) -> None:
    start, end = DAE.index("<library_visual_scenes>"), DAE.index("</COLLADA>")
    geometry = DAE[DAE.index("<geometry") : DAE.index("</library_geometries>")]
    second = geometry.replace('id="', 'id="2').replace('"#', '"#2')
    text = DAE[:start].replace("</library_geometries>", f"{second}</library_geometries>")
    vertices, faces = read_collada(written(tmp_path, text + DAE[end:]), 10_000)
    assert (len(vertices), len(faces)) == (8, 8)
    assert volume(vertices, faces) == pytest.approx(2 * TETRAHEDRON_M3)


def test_a_controller_shows_the_skin_that_it_moves(tmp_path: Path) -> None:
    skin = '<controller id="c"><skin source="#g"/></controller>'
    text = DAE.replace(
        "<library_visual", f"<library_controllers>{skin}</library_controllers><library_visual"
    )
    text = text.replace('<instance_geometry url="#g"/>', '<instance_controller url="#c"/>')
    assert volume(*read_collada(written(tmp_path, text), 10_000)) == pytest.approx(TETRAHEDRON_M3)


def test_a_node_that_is_shown_twice_is_there_twice(tmp_path: Path) -> None:
    """And nodes that show each other twice, level upon level, are not followed without end."""
    levels = "".join(
        f'<node id="n{k}">' + f'<instance_node url="#n{k + 1}"/>' * 2 + "</node>" for k in range(20)
    )
    deepest = '<node id="n20"><instance_geometry url="#g"/></node>'
    library = f"<library_nodes>{levels}{deepest}</library_nodes><library_visual"

    def shown(level: int) -> Path:
        text = DAE.replace("<library_visual", library, 1)
        return written(
            tmp_path,
            text.replace('<instance_geometry url="#g"/>\n', f'<instance_node url="#n{level}"/>\n'),
        )

    assert volume(*read_collada(shown(18), 10_000)) == pytest.approx(4 * TETRAHEDRON_M3)
    with pytest.raises(InputError, match=f"shows more than {_MOST_INSTANCES} things"):
        read_collada(shown(0), 10_000)


def test_positions_may_have_more_than_three_numbers_each(tmp_path: Path) -> None:
    accessor = '<technique_common><accessor stride="4" offset="1"/></technique_common>'
    rows = "9  0 0 0 9  5 0 0 9  0 6 0 9  0 0 7 9"
    text = DAE.replace('count="12">0 0 0 5 0 0 0 6 0 0 0 7<', f'count="17">{rows}<')
    text = text.replace(f"{rows}</float_array>", f"{rows}</float_array>{accessor}")
    vertices, _ = read_collada(written(tmp_path, text), 10_000)
    assert vertices.max(axis=0) == pytest.approx((0.05, 0.06, 0.07))


def test_a_file_larger_than_allowed_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"a\.dae"):
        read_collada(written(tmp_path, DAE), 100)
