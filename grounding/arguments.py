"""The command line of tamp-learn."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import tyro

from grounding.registry import RELATIONS
from grounding.relations.options import Ask, New, check_name
from tamp.errors import InputError
from tamp.system.options import read_command


@dataclass(frozen=True)
class Generate:
    """Make labelled scenes in physics; an interrupted run goes on where it was."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside."""
    split: str = "train"
    """train or test; they share no object and no support."""
    count: int = 20000
    """Scenes; half of them are positive."""
    layout: str = "household"
    """household: odd and small furniture, many bodies, any face down; or paper: as the paper's
    public code lays its scenes out, which is easier."""
    edges: bool = False
    """Of the layout paper: a share of the negatives is close by the limits, beside the surface at
    its height, grazing another body, poking out of the container. For training; not the paper's."""
    seed: int = 0
    """Of all randomness: the same seed gives the same bytes."""
    out: Path | None = None
    """The file; by default data/RELATION_SPLIT.npz."""
    meshes: Path | None = None
    """A folder of one's own meshes (OBJ, STL, PLY, URDF), one a subfolder as the YCB set comes:
    they join the objects. For training and test take different ones."""
    mesh_scale: float = 1.0
    """What makes their lengths metres: 0.001 for millimetres."""
    workers: int | None = None
    """Processes; by default one a core."""
    ray: str | None = None
    """Make them on a Ray cluster: its address, auto, or local."""


@dataclass(frozen=True)
class Explore:
    """Make labelled scenes by trying poses in physics; an interrupted run goes on where it was."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside, or one's own with --demos."""
    count: int = 1000
    """Scenes; in half of them the relation came to hold."""
    demos: Path | None = None
    """Of a relation of one's own: demonstrations. --out is a folder then, which gets candidates as
    demonstration files, with what the classifier takes them for: only that is to be looked over.
    """
    model: Path | None = None
    """Weights of a grounding that proposes half of the poses, moved at random; by default all poses
    are random.
    """
    seed: int = 0
    """Of all randomness: the same seed gives the same bytes."""
    out: Path | None = None
    """The file; by default data/RELATION_explored.npz. Train on it: tamp-learn train RELATION
    --data FILE.
    """
    meshes: Path | None = None
    """A folder of one's own meshes (OBJ, STL, PLY, URDF), one a subfolder as the YCB set comes:
    they join the objects. For training and test take different ones."""
    mesh_scale: float = 1.0
    """What makes their lengths metres: 0.001 for millimetres."""
    workers: int | None = None
    """Processes; by default one a core."""


@dataclass(frozen=True)
class Collect:
    """Make labelled scenes of problem files in which a relation of one's own holds, or does not."""

    relation: Annotated[str, tyro.conf.Positional]
    """Any name."""
    files: Annotated[tuple[Path, ...], tyro.conf.Positional]
    """Problem files, or folders of them. Their goals say what holds in them: (RELATION BODY PLACE),
    or (not (...)).
    """
    out: Path | None = None
    """The file; by default data/RELATION_train.npz."""


@dataclass(frozen=True)
class Encoder:
    """Train an encoder of point clouds, as models on clouds (mlp-pc, gnn-pc, tree-pc) need."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside, or one's own."""
    kind: str = "conv"
    """conv, which serves the models; pointnet++ and dense are for comparison."""
    scaling: str = "one"
    """Of the clouds: one factor for all (one), or each to the cube (each)."""
    shapes: Literal["data", "varied"] = "data"
    """Whose clouds: of the data set's bodies (data), or, without a data set, of furniture,
    household shapes and pybullet's meshes of random sizes (varied).
    """
    iterations: int | None = None
    """Batches; by default 4,000."""
    points: int | None = None
    """Of a cloud; by default 2,048."""
    seed: int = 0
    """Of initial weights and batches."""
    data: Path | None = None
    """The data set; by default data/RELATION_train.npz."""
    out: Path | None = None
    """The weights; by default weights/RELATION_encoder.safetensors."""


@dataclass(frozen=True)
class Train:
    """Train a grounding on a data set; the paper's networks go on where an interrupted run was."""

    relation: Annotated[str, tyro.conf.Positional]
    """on or inside, or one's own."""
    model: str = "transfer"
    """transfer or flow; the paper's mlp-bb, gnn-bb, mlp-pc, gnn-pc, tree-bb, tree-pc."""
    scheme: str | None = None
    """Of the paper's networks: what teaches the generator, discriminator, classifier or both; by
    default discriminator for on, both for others.
    """
    departures: tuple[str, ...] = ()
    """Of the paper's networks: what is done otherwise than there, any of residual-turn,
    middle-code, mean-weights, scaled-classifier, attention, own-choice, turned-scenes,
    scaled-scenes, edge-negatives (with data of generate --edges), turned-proposals."""
    samples: int | None = None
    """Use only so many of the scenes."""
    iterations: int | None = None
    """Of the paper's networks; by default 30,000 of the classifier and as many of the generator."""
    seed: int = 0
    """Of initial weights and batches."""
    data: Path | None = None
    """The data set; by default data/RELATION_train.npz."""
    encoder: Path | None = None
    """Of the models on clouds: what tamp-learn encoder has written, which is the default, or the
    weights of such a model, whose encoder is taken."""
    out: Path | None = None
    """The weights; by default weights/RELATION_MODEL.safetensors."""


@dataclass(frozen=True)
class Evaluate:
    """Judge a grounding on scenes that it never saw."""

    weights: Annotated[str, tyro.conf.Positional]
    """A weight file (.safetensors), or RELATION=NAME of what ships, such as on=surface."""
    model: str | None = None
    """What to make of the weights; by default what they were trained as. uniform+mlp is made of
    those of mlp-bb.
    """
    data: Path | None = None
    """The data set; by default data/RELATION_test.npz of the weights' relation."""
    scenes: int | None = None
    """At most so many scenes."""
    draws: int = 1
    """Poses a scene for the oracles on boxes; the published evaluation draws 9."""
    seed: int = 0
    """Of the scenes' order and of the draws."""
    demos: Path | None = None
    """Of a relation of one's own: demonstrations that it was not shown, to judge its classifier."""
    pictures: Path | None = None
    """Of a relation of one's own: a folder that gets pictures of what it would do."""


@dataclass(frozen=True)
class Show:
    """Draw scenes of a data set: of each type its share, green where the relation holds."""

    data: Annotated[Path, tyro.conf.Positional]
    """The data set (.npz)."""
    scenes: int = 12
    """How many, four in a row."""
    seed: int = 0
    """Of the choice."""
    out: Path = Path("scenes.png")
    """The picture (.png)."""


Arguments = New | Ask | Generate | Explore | Collect | Show | Encoder | Train | Evaluate

COMMANDS = {
    "new": New,
    "ask": Ask,
    "generate": Generate,
    "explore": Explore,
    "collect": Collect,
    "show": Show,
    "encoder": Encoder,
    "train": Train,
    "evaluate": Evaluate,
}


def parsed(arguments: list[str]) -> Arguments:
    """Parse the words of a command line.

    Raises:
        InputError: Something that the command does not know.
    """
    command = arguments[0] if arguments else ""
    if command not in (*COMMANDS, "-h", "--help"):
        raise InputError(
            f"unknown command '{command}'" if command else "no command",
            found=command,
            choices=COMMANDS,
        )
    chosen = read_command(COMMANDS, "tamp-learn", arguments)
    _check(chosen)
    return chosen


def _check(chosen: Arguments) -> None:
    if isinstance(chosen, New | Ask):
        check_name(chosen.relation)
    if (
        isinstance(chosen, Generate | Explore | Encoder | Train)
        and chosen.relation not in RELATIONS
        and not (isinstance(chosen, Explore) and chosen.demos is not None)
    ):
        _check_own(chosen)

    if isinstance(chosen, Encoder) and chosen.shapes == "varied" and chosen.data is not None:
        raise InputError("--shapes varied needs no data set: leave out --data")

    for name in ("count", "workers", "samples", "iterations", "points", "scenes", "pool"):
        number = vars(chosen).get(name)
        if number is not None and number < 1:
            raise InputError(f"--{name} must be positive, not {number}")

    if isinstance(chosen, Generate | Explore) and not 0.0 < chosen.mesh_scale < math.inf:
        raise InputError(f"--mesh-scale must be positive, not {chosen.mesh_scale}")
    if not isinstance(chosen, Collect) and not 0 <= chosen.seed < 2**63:
        raise InputError(f"--seed must be between 0 and 2**63, not {chosen.seed}")

    made = ".npz" if isinstance(chosen, Generate | Explore | Collect) else ".safetensors"
    for name, suffix in (
        ("out", ".png" if isinstance(chosen, Show) else made),
        ("data", ".npz"),
    ):
        path = vars(chosen).get(name)
        if isinstance(chosen, Explore) and chosen.demos is not None:
            continue
        if path is not None and path.suffix != suffix:
            raise InputError(f"--{name}: the file must end in {suffix}", file=path)


def _check_own(chosen: Generate | Explore | Encoder | Train) -> None:
    """Check that a relation of one's own has data of one's own."""
    relation = chosen.relation
    if isinstance(chosen, Encoder) and chosen.shapes == "varied":
        return
    if isinstance(chosen, Encoder | Train) and (
        chosen.data is not None or data_file(relation, "train").is_file()
    ):
        return
    remedy = f"Of one's own: tamp-learn collect {relation} FILES makes its data"
    raise InputError(
        f"unknown relation '{relation}'", found=relation, choices=RELATIONS, remedy=remedy
    )


def data_file(relation: str, split: str, layout: str = "household", edges: bool = False) -> Path:
    """Return the default path of a relation's data."""
    name = "_".join([*([] if layout == "household" else [layout]), *(["edges"] * edges), split])
    return Path("data") / f"{relation}_{name}.npz"
