"""A folder of good files of every kind that a command reads, for `benchmarks.bad_inputs` to spoil."""

from __future__ import annotations

import json
import shutil
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import trimesh

from tamp.system.files import shipped

PROBLEM = """\
# a scene
name: good
robot: {model: panda_mobile, base: [0, 0, 0]}
room: {x: [-2.5, 2.5], y: [-2.5, 2.5]}
domain: cupboard.pddl
bodies:
  table: {furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0], yaw: 90 deg}
  can: {cylinder: {radius: 0.03, height: 0.1}, on: table, at: [0.2, 0.1], mass: 0.3}
  thing: {mesh: thing.obj, on: table, at: [-0.3, 0.1], yaw: 0.5 rad}
  brick: {mesh: brick.stl, on: table, at: [-0.3, -0.2]}
  stool: {mesh: stool.urdf, fixed: true, at: [-1.5, 0.0, 0.0]}
goal: (and (on can table) (on thing table))
"""
CORNERS = "".join(f"v {x} {y} {z}\n" for x in (0, 0.05) for y in (0, 0.04) for z in (0, 0.1))
OBJ = f"mtllib thing.mtl\n{CORNERS}usemtl paint\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
MTL = "newmtl paint\nKd 0.8 0.1 0.1\nd 1.0\n"
URDF = """\
<?xml version="1.0"?>
<robot name="stool">
  <link name="seat">
    <inertial><origin xyz="0 0 0.2"/><mass value="3.0"/>
      <inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
    <visual><origin xyz="0 0 0.2" rpy="0 0 0"/><geometry><box size="0.4 0.4 0.4"/></geometry></visual>
    <collision><origin xyz="0 0 0.2" rpy="0 0 0"/><geometry><box size="0.4 0.4 0.4"/></geometry></collision>
  </link>
</robot>
"""
DOMAIN = """\
(define (domain blocks)
  (:requirements :strips :typing :negative-preconditions)
  (:types block)
  (:predicates (on ?x ?y - block) (clear ?x - block) (table ?x - block))
  (:action stack :parameters (?x ?y - block)
    :precondition (and (table ?x) (clear ?x) (clear ?y) (not (on ?x ?y)))
    :effect (and (on ?x ?y) (not (table ?x)) (not (clear ?y)))))
"""
TASK = """\
(define (problem two) (:domain blocks)
  (:objects a b c - block)
  (:init (table a) (table b) (table c) (clear a) (clear b) (clear c))
  (:goal (and (on a b) (on b c))))
"""
MESHES = """\
robot: {{model: panda_mobile, base: [0, 0, 0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
domain: cupboard
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0], yaw: 90 deg}}
  thing: {{mesh: {mesh}, on: table}}
goal: (on thing table)
"""
SUFFIXES = ("ply", "glb", "dae", "txt.stl")
"""Of the meshes that have a problem of their own, mesh.SUFFIX in m_SUFFIX.yaml."""

LABELLED = """\
robot: {{model: panda_mobile, base: [0, 0, 0]}}
room: {{x: [-2.5, 2.5], y: [-2.5, 2.5]}}
domain: cupboard
bodies:
  table: {{furniture: table, size: [1.2, 0.7, 0.72], at: [1.6, 0, 0], yaw: 90 deg}}
  can: {{box: [0.05, 0.06, 0.12], on: table, at: [{at}, 0.1]}}
goal: {goal}
"""
SAMPLER = """\
import numpy as np
class Nowhere:
    def propose(self, *arguments, **more):
        return iter(())
grounding = Nowhere()
"""


@dataclass(frozen=True)
class Door:
    """A kind of input: the file that is spoilt, how it is written, and the commands that read it.

    Attributes:
        name: Of the kind.
        file: The one that is spoilt.
        form: json, lines (JSON a line), text, yaml, binary or arrays: which faults it can have.
        lines: Command lines; one of them is run.
    """

    name: str
    file: str
    form: str
    lines: tuple[str, ...]


SCENE = ("tamp-solve p.yaml --time 2 --out out.json", "tamp-view p.yaml --png out.png --size 64x48")
PLAN = (
    "tamp-verify plan.json",
    "tamp-verify plan.json --json",
    "tamp-view plan.json --png out.png --size 64x48",
    "tamp-view plan.json --html out.html",
    "tamp-view plan.json --video out.gif --size 32x32 --speed 100",
    "tamp-export plan.json --format csv --out out.csv",
    "tamp-export plan.json --format ros",
    "tamp-execute plan.json --grasp constraint",
    "tamp-execute plan.json --replan --time 2",
)
DOORS = (
    Door("problem", "p.yaml", "yaml", (*SCENE, "tamp-bench run --problems p.yaml --seeds 1 --time 1 --out b2.jsonl")),
    Door("domain", "cupboard.pddl", "text", (SCENE[0], "tamp-verify plan.json --domain cupboard.pddl")),
    Door("streams", "cupboard.streams.pddl", "text", (SCENE[0],)),
    Door("obj", "thing.obj", "text", SCENE),
    Door("mtl", "thing.mtl", "text", SCENE),
    Door("stl", "brick.stl", "binary", SCENE),
    *(
        Door(suffix, f"mesh.{suffix}", "text" if suffix in ("dae", "txt.stl") else "binary",
             (f"tamp-solve m_{suffix}.yaml --time 2 --out out.json",)) for suffix in SUFFIXES
    ),
    Door("urdf", "stool.urdf", "text", SCENE),
    Door("plan", "plan.json", "json", PLAN),
    Door("symbolic domain", "d.pddl", "text", ("tamp-solve d.pddl t.pddl --time 2 --out out.json",)),
    Door("symbolic problem", "t.pddl", "text", ("tamp-solve d.pddl t.pddl --time 2 --out out.json",)),
    Door("symbolic plan", "sp.json", "json", ("tamp-verify sp.json",)),
    Door("statistics", "s.json", "json", ("tamp-solve p.yaml --time 2 --statistics s.json --out out.json",)),
    Door("data", "d.npz", "arrays", ("tamp-learn train lefty --data d.npz --out out.safetensors",
         "tamp-learn evaluate w.safetensors --data d.npz --scenes 2")),
    Door("data card", "d.json", "json", ("tamp-learn train lefty --data d.npz --out out.safetensors",
         "tamp-learn evaluate w.safetensors --data d.npz --scenes 2")),
    Door("weights", "w.safetensors", "binary", ("tamp-solve p.yaml --time 2 --sampler lefty=w.safetensors --out o.json",
         "tamp-learn evaluate w.safetensors --data d.npz --scenes 2")),
    Door("weights card", "w.json", "json", ("tamp-solve p.yaml --time 2 --sampler lefty=w.safetensors --out o.json",
         "tamp-learn evaluate w.safetensors --data d.npz --scenes 2")),
    Door("shipped weights", "on.safetensors", "binary",
         ("tamp-solve p.yaml --time 2 --sampler on=on.safetensors --out o.json",)),
    Door("shipped card", "on.json", "json", ("tamp-solve p.yaml --time 2 --sampler on=on.safetensors --out o.json",)),
    Door("demonstration", "demo/s0.yaml", "yaml", ("tamp-learn collect lefty demo --out out.npz",)),
    Door("log", "b.jsonl", "lines", ("tamp-bench table b.jsonl", "tamp-bench draw b.jsonl --out pictures",
         "tamp-bench run --problems p.yaml --samplers default --seeds 1 --time 1 --out b.jsonl")),
    Door("python", "mine.py", "text", ("tamp-solve p.yaml --time 2 --sampler on=mine.py --out out.json",)),
)  # fmt: skip
"""All doors but the command line's own words."""

OPTIONS = {
    "tamp-solve p.yaml": ("--time", "--seed", "--out", "--streams", "--sampler", "--algorithm", "--steering", "--jobs",
                          "--png", "--html", "--video", "--statistics", "--grasp"),
    "tamp-solve d.pddl t.pddl": ("--search", "--heuristic", "--time", "--jobs", "--out"),
    "tamp-verify plan.json": ("--problem", "--domain"),
    "tamp-execute plan.json": ("--grasp", "--disturb", "--seed", "--time", "--sampler", "--problem"),
    "tamp-export plan.json": ("--format", "--out"),
    "tamp-view plan.json --png out.png": ("--size", "--at", "--speed", "--problem", "--html", "--video"),
    "tamp-view plan.json --video out.gif": ("--size", "--speed"),
    "tamp-learn train lefty --data d.npz": ("--out", "--samples", "--seed", "--model", "--scheme", "--encoder"),
    "tamp-learn collect lefty": ("demo/s0.yaml --out", "d.npz --out", "demo --out"),
    "tamp-learn evaluate w.safetensors --data d.npz": ("--scenes", "--seed", "--model", "--data"),
    "tamp-learn generate on --workers 1": ("--split", "--seed", "--mesh-scale", "--meshes", "--out"),
    "tamp-bench table b.jsonl": ("--against",),
    "tamp-bench draw b.jsonl": ("--out",),
    "tamp-bench run --problems p.yaml --seeds 1": ("--samplers", "--time", "--algorithm", "--ray", "--out", "--first"),
}  # fmt: skip
"""Command lines and the options to which a bad word is given."""


def make(folder: Path, run: Callable[[str], int]) -> None:
    """Write good files into a folder.

    Args:
        folder: The one in which `run` runs.
        run: Runs a command line there; returns its exit status.
    """
    texts = {
        "p.yaml": PROBLEM, "thing.obj": OBJ, "thing.mtl": MTL, "stool.urdf": URDF, "d.pddl": DOMAIN, "t.pddl": TASK,
        "mine.py": SAMPLER,
    }  # fmt: skip
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "brick.stl").write_bytes(_brick())
    for suffix in (".pddl", ".streams.pddl"):
        shutil.copy(shipped("domains") / f"cupboard{suffix}", folder / f"cupboard{suffix}")
    box = trimesh.creation.box((0.06, 0.05, 0.08))
    for suffix in SUFFIXES:
        box.export(folder / f"mesh.{suffix}", file_type="stl_ascii" if suffix == "txt.stl" else suffix)
        (folder / f"m_{suffix}.yaml").write_text(MESHES.format(mesh=f"mesh.{suffix}"), encoding="utf-8")
    (folder / "demo").mkdir()
    for number in range(8):
        goal = "(lefty can table)" if number % 2 else "(not (lefty can table))"
        text = LABELLED.format(at=0.02 * number * (-1) ** number, goal=goal)
        (folder / "demo" / f"s{number}.yaml").write_text(text, encoding="utf-8")
    grounding = Path(__file__).resolve().parents[1] / "grounding" / "assets"
    for suffix in (".safetensors", ".json"):
        shutil.copy(grounding / f"on_transfer{suffix}", folder / f"on{suffix}")
    words = "name", "solved"
    config = {"problem": "p", "sampler": "default", "seed": 0, "time": 1.0, "algorithm": "adaptive", "samplers": {}}
    line = {"config": config, "seed": 0, "outcome": "SOLVED", "solved": True, "verified": True, "planning_s": 0.5,
            "parts_s": {"symbolic": 0.1, "ik": 0.4}, "cpu_s": 0.5, "commit": "0", "load": 0.1, "actions": 2,
            "streams": {"x": {"calls": 1, "successes": 1, "seconds": 0.1, "reasons": {}}},
            "machine": {"cpu": words[0], "cores": 2, "host": "h"}}  # fmt: skip
    lines = [{**line, "config": {**config, "seed": seed}, "seed": seed} for seed in range(3)]
    (folder / "b.jsonl").write_text("".join(json.dumps(one) + "\n" for one in lines), encoding="utf-8")
    for command in (
        "tamp-solve p.yaml --out plan.json --statistics s.json --record",
        "tamp-solve d.pddl t.pddl --out sp.json",
        "tamp-learn collect lefty demo --out d.npz",
        "tamp-learn train lefty --data d.npz --out w.safetensors",
    ):
        if run(command) != 0:
            raise RuntimeError(f"a good input is refused: {command}")


def _brick() -> bytes:
    """A box as binary STL."""
    corners = [(x, y, z) for x in (0.0, 0.06) for y in (0.0, 0.05) for z in (0.0, 0.08)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    rows = [struct.pack("<12fH", 0, 0, 0, *(n for corner in face for n in corners[corner]), 0) for face in faces]
    return bytes(80) + struct.pack("<I", len(faces)) + b"".join(rows)
