"""The saved state of a training, from which an interrupted one goes on."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from safetensors import SafetensorError, safe_open
from safetensors.torch import save
from torch import Tensor

from tamp.errors import InputError
from tamp.system.files import write_whole


def save_state(path: Path, tensors: Mapping[str, Tensor], run: str) -> None:
    """Write the tensors of a training, with the identity of its run."""
    detached = {name: tensor.detach() for name, tensor in tensors.items()}
    write_whole(path, save(detached, {"run": run}))


def load_state(path: Path, tensors: Mapping[str, Tensor], run: str) -> None:
    """Read a saved state into the tensors, in place.

    Raises:
        InputError: The state is damaged, or of another run than `run`.
    """
    remedy = f"Train from the beginning: delete {path}"
    try:
        with safe_open(path, "pt") as file:
            metadata = file.metadata() or {}
            found = {name: file.get_tensor(name) for name in sorted(file.keys())}
    except (SafetensorError, OSError, ValueError) as error:
        raise InputError(f"the state is damaged: {error}", file=path, remedy=remedy) from None

    if metadata.get("run") != run:
        raise InputError("the state of another training", file=path, remedy=remedy)
    wanted = {name: (tensor.shape, tensor.dtype) for name, tensor in tensors.items()}
    if wanted != {name: (tensor.shape, tensor.dtype) for name, tensor in found.items()}:
        raise InputError("the state is damaged: its arrays are others", file=path, remedy=remedy)

    for name, tensor in tensors.items():
        tensor.copy_(found[name])
