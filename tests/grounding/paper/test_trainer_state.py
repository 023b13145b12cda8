"""The saved state of a training: read back in place, or refused before anything is changed."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tamp.errors import InputError

torch = pytest.importorskip(
    "torch", reason="it trains, and torch without CUDA has no wheel for this Python"
)
from grounding.paper.trainer_state import load_state, save_state  # noqa: E402


def tensors(value: float = 0.0) -> dict[str, Any]:
    return {"weights": torch.full((2, 3), value), "step": torch.tensor([int(value)])}


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    path = tmp_path / "state.safetensors"
    save_state(path, tensors(3.0), "run 1")
    return path


def test_a_state_is_read_into_the_tensors_themselves(saved: Path) -> None:
    into = tensors()
    kept = into["weights"]
    load_state(saved, into, "run 1")
    assert into["weights"] is kept and (kept == 3.0).all() and into["step"].item() == 3


def test_what_a_training_still_follows_is_saved_without_its_history(tmp_path: Path) -> None:
    followed = (torch.ones(2, requires_grad=True) * 2).sum().reshape(1)
    save_state(tmp_path / "s", {"loss": followed}, "run")
    into = {"loss": torch.zeros(1)}
    load_state(tmp_path / "s", into, "run")
    assert into["loss"].item() == 4.0 and not into["loss"].requires_grad


def refused(path: Path, into: dict[str, Any], run: str = "run 1") -> str:
    before = {name: tensor.clone() for name, tensor in into.items()}
    with pytest.raises(InputError) as caught:
        load_state(path, into, run)
    assert all(torch.equal(into[name], before[name]) for name in into)
    assert f"delete {path}" in str(caught.value)
    return caught.value.message


def test_a_state_of_another_run(saved: Path) -> None:
    assert refused(saved, tensors(), "run 2") == "the state of another training"


@pytest.mark.parametrize(
    "into",
    [
        {"weights": torch.zeros(2, 3)},
        {**tensors(), "more": torch.zeros(1)},
        {**tensors(), "weights": torch.zeros(3, 2)},
        {**tensors(), "weights": torch.zeros(2, 3, dtype=torch.float64)},
    ],
)
def test_a_state_of_other_arrays(saved: Path, into: dict[str, Any]) -> None:
    assert refused(saved, into) == "the state is damaged: its arrays are others"


@pytest.mark.parametrize("content", [b"", b"nothing", None])
def test_a_file_that_is_none(saved: Path, content: bytes | None) -> None:
    whole = saved.read_bytes()
    saved.write_bytes(whole[:-4] if content is None else content)
    assert refused(saved, tensors()).startswith("the state is damaged: ")


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    assert refused(tmp_path / "none", tensors()).startswith("the state is damaged: ")
