"""The files that a plan was made from: found beside it, hashed, and never quoted when they may be secret."""

from __future__ import annotations

import hashlib
from dataclasses import replace
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.plan.read import PlanFile, PlanSource
from tamp.plan.sources import check_files, plan_hashes, sha256, source_file, unquoted
from tests.plan.making import plan_of


def made_from(folder: Path, **sources: tuple[Path, str]) -> PlanFile:
    """A plan in a folder that names files by role."""
    named = tuple(PlanSource(role, path, digest) for role, (path, digest) in sources.items())
    return replace(plan_of(), file=folder / "plan.json", sources=named)


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    path = tmp_path / "cup.obj"
    path.write_bytes(b"v 0 0 0\n")
    return path


def digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def test_the_hash_is_sha256_of_the_contents(mesh: Path) -> None:
    assert sha256(mesh) == digest(mesh)
    with pytest.raises(InputError, match="it cannot be read: No such file"):
        sha256(mesh.with_name("gone"))


def test_a_source_is_where_the_plan_says_or_beside_the_plan(tmp_path: Path) -> None:
    there, beside = tmp_path / "far" / "p.yaml", tmp_path / "p.yaml"
    plan = made_from(tmp_path, problem=(there, "0" * 64))
    with pytest.raises(
        InputError, match=r"the plan's problem .*p.yaml is missing. Give --problem FILE"
    ):
        source_file(plan, "problem", None)
    beside.write_text("")
    assert source_file(plan, "problem", None) == beside
    there.parent.mkdir()
    there.write_text("")
    assert source_file(plan, "problem", None) == there
    assert source_file(plan, "problem", beside) == beside  # the user's word counts most
    with pytest.raises(InputError, match="the plan does not say from which domain it was made"):
        source_file(plan, "domain", None)


def test_changed_missing_and_new_files_are_told(tmp_path: Path, mesh: Path) -> None:
    problem = tmp_path / "p.yaml"
    problem.write_text("a")
    plan = made_from(tmp_path, problem=(problem, digest(problem)), mesh=(mesh, digest(mesh)))
    assert list(check_files(plan, {"problem": problem}, (mesh,))) == []

    problem.write_text("b")
    (changed,) = check_files(plan, {"problem": problem}, (mesh,))
    assert (
        changed.kind == "hash"
        and "the problem" in changed.message
        and "is not the one" in changed.message
    )
    problem.write_text("a")

    new = tmp_path / "new.obj"
    new.write_bytes(b"v 1 1 1\n")
    (added,) = check_files(plan, {"problem": problem}, (mesh, new))
    assert "new.obj is not one that the plan was made from" in added.message
    (gone,) = check_files(plan, {"problem": problem}, ())
    assert gone.message == "the plan was made from a mesh cup.obj that the problem does not have"


def test_a_mesh_may_have_another_name_but_not_another_content(tmp_path: Path, mesh: Path) -> None:
    plan = made_from(tmp_path, mesh=(Path("/elsewhere/mug.obj"), digest(mesh)))
    assert list(check_files(plan, {}, (mesh,))) == []


def quoting(file: Path) -> None:
    raise InputError("expected a mapping, found 'top secret'", file=file, line=3)


def test_a_file_that_only_a_plan_names_is_not_quoted(tmp_path: Path) -> None:
    secret = tmp_path / "secret"
    secret.write_text("top secret")
    plan = made_from(tmp_path, problem=(secret, "0" * 64))
    message = "the plan names this file, but was made from another one"
    with pytest.raises(InputError, match=message) as told, unquoted(plan.file, plan_hashes(plan)):
        quoting(secret)
    assert "top secret" not in str(told.value) and told.value.line == 3


@pytest.mark.parametrize("known", ["hash", "given", "plan"])
def test_a_file_that_is_known_already_is_quoted(tmp_path: Path, known: str) -> None:
    file = tmp_path / "p.yaml"
    file.write_text("top secret")
    plan = made_from(tmp_path, problem=(file, digest(file) if known == "hash" else "0" * 64))
    hashes = plan_hashes(plan, problem=file if known == "given" else None)
    with (
        pytest.raises(InputError, match="top secret"),
        unquoted(file if known == "plan" else plan.file, hashes),
    ):
        quoting(file)


def test_errors_without_a_file_pass(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"^too slow$"), unquoted(tmp_path / "plan.json", {}):
        raise InputError("too slow")
