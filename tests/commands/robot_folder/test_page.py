"""docs/adding-a-robot.md, as a user follows it, with a robot that does not come with tamp."""

from __future__ import annotations

import json
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

from tamp.geometric.loading.robots import ROBOTS, SHIPPED
from tests.commands.robot_folder.urdf import write_arm
from tests.needs import INSTALLED

ROOT = Path(__file__).resolve().parents[3]
PAGE = (ROOT / "docs" / "adding-a-robot.md").read_text(encoding="utf-8")
SCHEMA = json.loads((ROOT / "tamp/geometric/loading/robot.schema.json").read_text(encoding="utf-8"))


def errors(folder: Path) -> list[str]:
    jsonschema = pytest.importorskip("jsonschema")
    document = yaml.safe_load((folder / "robot.yaml").read_text(encoding="utf-8"))
    return [
        error.message for error in jsonschema.Draft202012Validator(SCHEMA).iter_errors(document)
    ]


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_robots_follow_the_schema(name: str) -> None:
    assert errors(ROBOTS[name]().folder) == []


def test_made_robots_follow_the_schema(driving: Path, lifting: Path, bolted: Path) -> None:
    assert [errors(folder) for folder in (driving, lifting, bolted)] == [[], [], []]


@pytest.mark.slow
def test_the_page_leads_from_a_urdf_to_a_plan_that_is_carried_out(tmp_path: Path) -> None:
    found = re.search(r"```sh\n(.*?)```", PAGE, re.DOTALL)
    assert found is not None
    commands = found[1].strip().splitlines()
    assert len(commands) == 4
    if "pybullet" not in INSTALLED:  # nor are its files: an arm of ours takes the place of theirs
        urdf = "pybullet_data/kuka_iiwa/model.urdf"
        assert urdf in commands[0]
        commands[0] = commands[0].replace(urdf, f"{write_arm(tmp_path)} --arm foot tool")
    for command in commands:
        program, *words = shlex.split(command)
        run = subprocess.run(
            [str(Path(sys.executable).with_name(program)), *words],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
            timeout=600,
        )
        assert run.returncode == 0, f"{command}\n{run.stdout}{run.stderr}"
    assert (tmp_path / "robots" / "iiwa" / "robot.yaml").is_file()
    assert json.loads((tmp_path / "plan.json").read_text())["robot"] == str(
        tmp_path / "robots" / "iiwa"
    )
