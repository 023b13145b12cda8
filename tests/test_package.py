"""The wheel and the sdist, each installed into a fresh environment, solve a problem from another directory."""

from __future__ import annotations

import json
import os
import site
import subprocess
import sys
import tarfile
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
pytestmark = [pytest.mark.slow, pytest.mark.timeout(300)]


def call(command: Sequence[str | Path], cwd: Path) -> subprocess.CompletedProcess[str]:
    env = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    run = subprocess.run(
        [str(word) for word in command],
        cwd=cwd,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 0, f"{command}\n{run.stdout}\n{run.stderr}"
    return run


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The sdist, and the wheel built from the unpacked sdist: what a package index would get."""
    folder = tmp_path_factory.mktemp("dist")
    call([sys.executable, "-m", "build", "--no-isolation", "--outdir", folder, ROOT], folder)
    return {"wheel": next(folder.glob("*.whl")), "sdist": next(folder.glob("*.tar.gz"))}


def install(package: Path, folder: Path) -> Path:
    """A fresh environment with `package`, seeing the running one's dependencies but not its tamp; its bin folder."""
    call([sys.executable, "-m", "venv", "--without-pip", folder], folder.parent)
    own = folder / "lib" / f"python3.{sys.version_info.minor}" / "site-packages"
    for number, outer in enumerate(site.getsitepackages()):
        (own / f"outer{number}.pth").write_text(f"{outer}\n", encoding="utf-8")
        for pth in Path(outer).glob(
            "cmeel.pth"
        ):  # pinocchio's folder; what it imports must be found by then
            (own / f"outer{number}_{pth.name}").write_text(
                pth.read_text(encoding="utf-8"), encoding="utf-8"
            )
    pip = [sys.executable, "-m", "pip", "--python", folder / "bin" / "python", "install", "--quiet"]
    call(
        [*pip, "--no-index", "--no-deps", "--ignore-installed", "--no-build-isolation", package],
        folder.parent,
    )
    return folder / "bin"


@pytest.mark.parametrize("kind", ["wheel", "sdist"])
def test_installed_package_solves_by_name_from_another_directory(
    kind: str, built: dict[str, Path], tmp_path: Path
) -> None:
    programs = install(built[kind], tmp_path / "fresh")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    where = call([programs / "python", "-c", "import tamp; print(tamp.__file__)"], elsewhere).stdout
    assert Path(where.strip()).is_relative_to(tmp_path / "fresh")
    call([programs / "tamp-solve", "one_object", "--out", "plan.json"], elsewhere)
    plan = json.loads((elsewhere / "plan.json").read_text(encoding="utf-8"))
    assert [action["name"] for action in plan["actions"]].count("place") >= 1
    call([programs / "tamp-verify", "plan.json"], elsewhere)


def test_wheel_holds_the_data_and_nothing_foreign(built: dict[str, Path]) -> None:
    names = zipfile.ZipFile(built["wheel"]).namelist()
    assert {name.partition("/")[0].partition("-")[0] for name in names} == {
        "tamp",
        "tamp_planner",
        "grounding",
    }
    shipped = {name.removeprefix("tamp/_data/") for name in names if name.startswith("tamp/_data/")}
    here = [
        path
        for folder in ("domains", "problems")
        for path in (ROOT / folder).rglob("*")
        if path.is_file()
    ]
    assert shipped == {str(path.relative_to(ROOT)) for path in here}
    assert "domains/cupboard.pddl" in shipped
    weights = {path.name for path in (ROOT / "grounding" / "assets").iterdir()}
    assert {
        name.rpartition("/")[2] for name in names if name.startswith("grounding/assets/")
    } == weights
    assert "on_transfer.safetensors" in weights


def test_sdist_builds_and_tests(built: dict[str, Path]) -> None:
    with tarfile.open(built["sdist"]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    assert {
        "pyproject.toml",
        "constraints.txt",
        "Makefile",
        "LICENSE",
        "README.md",
        "tests/test_package.py",
    } <= names
    assert not any(name.startswith((".venv", "dist/")) for name in names)
