"""Write docs/modules.md: every module with what it is for and its public names, by folder, from the docstrings.

    python -m benchmarks.module_index

`tests/test_docs.py` compares the page with the code.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from benchmarks.common import without_options

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "modules.md"
PACKAGES = ("tamp", "grounding")
MOST_NAMES = 8
"""Public names of a module that are listed."""

HEAD = """# Every module
What each file is for, in the words of its docstring, and what is public in it. Search this page for your word; which
question leads where is in [the map](how-it-works.md#the-map). Written by `python -m benchmarks.module_index`.
"""


def index() -> str:
    """Return the page's text."""
    parts = [HEAD]
    for package in PACKAGES:
        for folder in sorted({path.parent for path in (ROOT / package).rglob("*.py")}):
            rows = list(_rows(folder))
            if not rows:
                continue

            parts.append(f"## {folder.relative_to(ROOT).as_posix()}")
            parts.append(f"{_first(folder / '__init__.py')}\n")
            parts.append("| file | what it is for | names |\n|---|---|---|")
            parts.append("\n".join(rows) + "\n")
    return "\n".join(parts)


def _rows(folder: Path) -> Iterator[str]:
    for path in sorted(folder.glob("*.py")):
        if path.name != "__init__.py":
            names = ", ".join(f"`{name}`" for name in _public(path)[:MOST_NAMES])
            yield f"| `{path.name}` | {_first(path)} | {names} |"


def _first(path: Path) -> str:
    """Return the first paragraph of a module's docstring, on one line."""
    said = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return " ".join(said.split("\n\n")[0].split()).replace("|", r"\|")


def _public(path: Path) -> list[str]:
    """List public functions and classes, then public constants, in their order in the file."""
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    body = ast.parse(path.read_text(encoding="utf-8")).body
    names = [one.name for one in body if isinstance(one, kinds)]
    for one in body:
        targets = one.targets if isinstance(one, ast.Assign) else [getattr(one, "target", None)]
        names += [target.id for target in targets if isinstance(target, ast.Name) and target.id.isupper()]
    return [name for name in names if not name.startswith("_")]


if __name__ == "__main__":
    without_options(__doc__)
    PAGE.write_text(index(), encoding="utf-8")
    print(f"{PAGE.relative_to(ROOT)} written")
