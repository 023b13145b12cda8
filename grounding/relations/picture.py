"""Pictures of generated scenes."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from grounding.relations.demonstration_file import Label
from grounding.relations.demonstration_text import (
    BodyEntry,
    DemonstrationFile,
    write_demonstration,
)

COLOURS = ("orange", "blue", "green", "purple", "turquoise", "yellow")
"""Of the arguments, in their order."""


def write_picture(
    path: Path, bodies: Mapping[str, BodyEntry], arguments: Sequence[str], name: str
) -> None:
    """Write a picture of a scene, the arguments in colours of their order.

    Raises:
        InputError: The file cannot be written.
    """
    from tamp.view.open import open_timeline
    from tamp.view.picture import write_png

    coloured = dict(bodies)
    for argument, colour in zip(arguments, COLOURS, strict=False):
        if argument in coloured:
            shape = {**coloured[argument].shape, "colour": colour}
            coloured[argument] = replace(coloured[argument], shape=shape)
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.yaml"
        write_demonstration(
            file, DemonstrationFile(coloured, [Label(name, tuple(arguments), True)])
        )
        timeline, _, _ = open_timeline(str(file))
        write_png(timeline, path)
