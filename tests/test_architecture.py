"""The house rules that a machine can check: layers, file sizes, what starts when."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SYMBOLIC = ("tamp/symbolic/pddl", "tamp/symbolic/search", "tamp/symbolic/algorithms")
LONGEST = 300
HEAVY = {
    "torch",
    "pybullet",
    "networkx",
    "trimesh",
    "toppra",
    "scipy",
    "ompl",
    "fcl",
    "pinocchio",
    "eaik",
    "coacd",
    "matplotlib",
    "ray",
}
EXTRAS = {"matplotlib": {"tamp/benchmark/picture.py"}, "ray": {"tamp/benchmark/ray_pool.py"}}
DISTRIBUTIONS = {
    "PIL": "pillow",
    "fcl": "python-fcl",
    "mujoco": "mujoco-core",
    "pinocchio": "pin",
    "sklearn": "scikit-learn",
    "yaml": "pyyaml",
}
"""Where a package's import name is not its name on PyPI."""


def sources(*folders: str) -> list[Path]:
    files = sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))
    assert files, folders
    return files


def imported(file: Path) -> Iterator[str]:
    """The top-level packages that a file imports, inside functions too."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name.partition(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.module.partition(".")[0]


def test_folders_import_only_from_folders_below() -> None:
    linter = Path(sys.executable).with_name("lint-imports")
    run = subprocess.run(
        [str(linter), "--no-cache"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout + run.stderr
    assert "0 broken" in run.stdout


COMPILED = {
    ROOT / "tamp/symbolic/search" / folder / "compiled.py"
    for folder in ("heuristics/loops", "packed")
}


@pytest.mark.parametrize("folder", SYMBOLIC)
def test_the_symbolic_half_is_pure_standard_library_but_for_its_compiled_loops(folder: str) -> None:
    foreign = {
        f"{file.relative_to(ROOT)}: {name}"
        for file in sources(folder)
        for name in imported(file)
        if name not in sys.stdlib_module_names
        and name != "tamp"
        and not (file in COMPILED and name in {"numpy", "numba"})
        and not (file == ROOT / "tamp/symbolic/pddl/stratification.py" and name == "networkx")
    }
    assert not foreign


def test_files_stay_short() -> None:
    lengths = {
        str(file.relative_to(ROOT)): len(file.read_text(encoding="utf-8").splitlines())
        for file in sources("tamp", "grounding")
    }
    assert {file: lines for file, lines in lengths.items() if lines > LONGEST} == {}


def test_no_global_state_no_asserts_no_probing() -> None:
    found = {
        f"{file.relative_to(ROOT)}:{node.lineno}: {ast.unparse(node)[:60]}"
        for file in sources("tamp", "grounding")
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Assert | ast.Global)
        or (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Name)
            and node.func.id in {"hasattr", "eval", "exec"}
        )
    }
    assert found == set()
    assert not [
        file
        for file in sources("tamp", "grounding")
        if file.name in {"utils.py", "helpers.py", "common.py"}
    ]


def test_dependencies_are_what_the_code_imports() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    declared = {line.partition(">=")[0].lower() for line in project["dependencies"]}
    extras = {
        extra: {re.split("[>=]=", line)[0] for line in project["optional-dependencies"][extra]}
        for extra in ("learn", "bench", "ray")
    }
    own = {
        "tamp",
        "grounding",
        "jaxtyping",
        *sys.stdlib_module_names,
    }  # jaxtyping: see tests/test_shapes.py
    needed = {
        folder: {
            DISTRIBUTIONS.get(name, name) for file in sources(folder) for name in imported(file)
        }
        - own
        for folder in ("tamp", "grounding")
    }
    benchmarks = extras["bench"] | extras["ray"]
    assert not needed["tamp"] & (extras["learn"] - benchmarks)
    assert (needed["tamp"] | needed["grounding"]) - extras["learn"] - benchmarks == declared


def test_the_extras_of_benchmarks_stay_there() -> None:
    using = {
        name: {str(file.relative_to(ROOT)) for file in sources("tamp") if name in imported(file)}
        for name in EXTRAS
    }
    assert using == EXTRAS


def test_torch_stays_where_training_is() -> None:
    files = {
        str(file.relative_to(ROOT))
        for file in sources("grounding")
        if {"torch", "sklearn"} & {*imported(file)}
    }
    assert files == {
        "grounding/torch_layers.py",
        "grounding/paper/posed_clouds.py",
        *(f"grounding/relational/{name}.py" for name in ("training", "flow_training")),
        *(
            f"grounding/paper/{name}.py"
            for name in (
                "cloud_embeddings",
                "posed_clouds",
                "critic",
                "encoders",
                "networks",
                "random_streams",
                "trainer",
                "trainer_state",
                "training_scenes",
                "tree_training",
            )
        ),
    }


@pytest.mark.parametrize(
    "module",
    [
        "tamp",
        "tamp.commands.solve",
        "tamp.commands.verify",
        "tamp.commands.export",
        "tamp.commands.view",
        "tamp.commands.bench",
    ],
)
def test_nothing_heavy_is_imported_at_start(module: str) -> None:
    code = f"import sys, json, {module}; print(json.dumps(sorted(sys.modules)))"
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    modules = {name.partition(".")[0] for name in json.loads(run.stdout)}
    assert "tamp" in modules
    assert modules & HEAVY == set()


@pytest.mark.parametrize(
    "module", ["registry", "surface", "paper.runtime", "paper.trees", "paper.uniform"]
)
def test_groundings_work_without_the_extra_they_are_trained_with(module: str) -> None:
    code = f"import sys, grounding.{module}; print(*(name for name in ('torch', 'sklearn') if name in sys.modules))"
    run = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert run.stdout.strip() == ""
