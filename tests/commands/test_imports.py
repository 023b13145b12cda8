"""Commands import what they use: by name, since seconds depend on the machine."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

SOLVE = "from tamp.commands.solve import run; run(['one_object', '--quiet', '--out', 'plan.json'])"
HELP = {
    "verify": "from tamp.commands.verify import main; main(['--version-of-nothing'])",
    "view": "from tamp.commands.view import main; main(['--version-of-nothing'])",
    "export": "from tamp.commands.export import main; main(['--version-of-nothing'])",
}
NEVER = (
    "matplotlib",
    "torch",
    "trimesh",
    "networkx",
    "typeguard",
    "asyncio",
    "unittest.mock",
    "jaxtyping",
)
"""What no command needs to say what it was asked for."""
PLANNING = (
    "pybullet",
    "mujoco",
    "pinocchio",
    "numba.np.linalg",
    "tamp.verification",
    "tamp.execution.report",
)
"""What a plan of one object can be found without, once the kernels are compiled."""
HEAVY = (
    "numba",
    "llvmlite",
    "scipy",
    "pinocchio",
    "ompl",
    "fcl",
    "pybullet",
    "mujoco",
    "tamp.geometric.collision",
)
"""What reading a command line needs none of."""


def imported(words: str, folder: Path) -> set[str]:
    """The modules that are there after some words of Python, in a process of their own."""
    code = f"import sys\ntry:\n    {words}\nexcept SystemExit:\n    pass\nprint('\\n'.join(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=True
    )
    return set(done.stdout.splitlines())


def test_a_plan_imports_no_judge_no_engine_and_no_compiler(tmp_path: Path) -> None:
    imported(SOLVE, tmp_path)  # compiles the kernels where that has not been done
    modules = imported(SOLVE, tmp_path)
    assert (tmp_path / "plan.json").is_file()
    assert modules.isdisjoint((*NEVER, *PLANNING))
    assert "numba" in modules


@pytest.mark.parametrize("command", HELP)
def test_reading_a_command_line_imports_nothing_heavy(command: str, tmp_path: Path) -> None:
    modules = imported(HELP[command], tmp_path)
    assert f"tamp.commands.{command}" in modules
    assert modules.isdisjoint((*NEVER, *HEAVY))
