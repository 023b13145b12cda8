"""Nothing that we tell anybody to type fetches the package `tamp` of the public index, which is not ours."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from importlib.metadata import entry_points, version
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import tamp
from tamp.system.distribution import DISTRIBUTION, distribution_version, install_command

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = (
    "tamp",
    "grounding",
    "tests",
    "benchmarks",
    "examples",
    "docs",
    "domains",
    "problems",
    "findings",
    ".ci",
    ".github",
)
SUFFIXES = {
    ".py",
    ".md",
    ".toml",
    ".txt",
    ".sh",
    ".yml",
    ".yaml",
    ".cfg",
    ".html",
    ".js",
    ".pddl",
    "",
}
OTHERS = re.compile(
    r"""
    (?: \b(?:pip|pip3|pipx|uv|uvx|poetry|pdm|hatch|rye|conda|mamba)\b   # a program that fetches,
        (?: [^\n`;|&#]* \s
            (?:install|download|wheel|add|run|inject|tool|sync|-w|--with|--from)
        | (?<=uvx) )                                                    # a verb of its own,
        (?: [^\n`;|&#]* [\s"'=] | \s+ )                                 # whatever options,
        tamp (?= [\s"'`\[=<>~!,;@)] | \.?$ | \.\s )                     # and the bare name
    | ["']install["'] [^\n\]]* ["']tamp (?= ["'\[=<>~!] )               # the same as a list of words
    | (?<! [\w-] ) tamp \[ [a-z]+ (?: ,\s*[a-z]+ )* \]                  # an extra of it, by whatever program
    | \b(?:version|distribution|metadata|requires|files)\( ["']tamp["'] \)
    )
    """,
    re.VERBOSE | re.MULTILINE,
)


def texts() -> Iterator[tuple[str, str]]:
    files = [path for path in ROOT.iterdir() if path.is_file()]
    for folder in FOLDERS:
        files += [path for path in (ROOT / folder).rglob("*") if path.is_file()]
    for path in sorted(files):
        if path.suffix in SUFFIXES and path != Path(__file__) and "results" not in path.parts:
            yield str(path.relative_to(ROOT)), path.read_text(encoding="utf-8", errors="replace")


def test_no_text_of_ours_fetches_the_other_package() -> None:
    looked = dict(texts())
    assert {
        "README.md",
        "Makefile",
        "pyproject.toml",
        "tamp/benchmark/picture.py",
        "docs/benchmarking.md",
    } <= {*looked}

    found = {
        f"{name}:{text.count(chr(10), 0, match.start()) + 1}: {match[0]}"
        for name, text in looked.items()
        for match in OTHERS.finditer(text)
    }
    assert found == set()


@pytest.mark.parametrize(
    "words",
    [
        "pip install tamp",
        "pip install 'tamp[ray]'",
        "python -m pip install -q tamp==0.1.0",
        "pip install --upgrade numpy tamp",
        "pipx install tamp",
        "pipx run --spec tamp tamp-solve",
        "uv pip install tamp",
        "uv tool install 'tamp[bench]'",
        "uv add tamp",
        "uvx tamp",
        "uvx --from tamp tamp-solve",
        '["pip", "install", "tamp"]',
        "Get it by `pip install tamp`.",
        "needs tamp[learn]",
        'importlib.metadata.version("tamp")',
    ],
)
def test_such_a_command_would_be_found(words: str) -> None:
    assert OTHERS.search(words)


@pytest.mark.parametrize(
    "words",
    [
        "pip install -c constraints.txt .",
        "pip install 'tamp-planner[ray]'",
        "pip install tamp-planner",
        "pip uninstall tamp",
        "uv pip install ./tamp",
        "pip install -e .  # where tamp lies",
        "pip install numpy, then `python -m tamp`",
        "tamp-solve one_object",
        "from tamp import solve",
    ],
)
def test_what_fetches_ours_or_nothing_is_let_be(words: str) -> None:
    assert not OTHERS.search(words)


def test_the_projects_own_requirements_name_ours() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = project["optional-dependencies"]
    required = [
        Requirement(line) for lines in (project["dependencies"], *extras.values()) for line in lines
    ]

    assert project["name"] == DISTRIBUTION == "tamp-planner"
    assert "tamp" not in {requirement.name for requirement in required}
    assert {"bench", "ray"} == {
        extra
        for requirement in required
        if requirement.name == DISTRIBUTION
        for extra in requirement.extras
    }


@pytest.mark.parametrize("extra", ["bench", "learn", "ray"])
def test_the_remedy_names_an_extra_that_there_is(extra: str) -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    named = Requirement(install_command(extra).removeprefix("pip install ").strip("'"))
    assert named.name == project["name"]
    assert named.extras <= {*project["optional-dependencies"]}


def test_the_import_name_and_the_commands_stay() -> None:
    assert tamp.__name__ == "tamp"
    assert distribution_version() == version(DISTRIBUTION)
    commands = {
        command.name
        for command in entry_points(group="console_scripts")
        if command.value.startswith("tamp.")
    }
    assert commands == {
        f"tamp-{word}"
        for word in (
            "solve",
            "verify",
            "execute",
            "export",
            "learn",
            "demo",
            "robot",
            "view",
            "bench",
        )
    }


def test_a_version_that_is_not_installed_is_said_to_be_unknown() -> None:
    assert distribution_version("no-such-distribution-of-ours") == "unknown"
