"""docs/symbolic-engine.md prints what it says: its code is run block by block, and its outputs are compared.

`python tests/test_symbolic_engine.py` renews the outputs.
"""

from __future__ import annotations

import contextlib
import io
import re
from pathlib import Path

PAGE = Path(__file__).resolve().parent.parent / "docs" / "symbolic-engine.md"
BLOCK = re.compile(r"```python\n(.*?)```\n(?:\n```text\n.*?```\n)?", re.DOTALL)


def renewed(page: str) -> str:
    """The page with the output of each of its blocks behind it, all run in one namespace."""
    namespace: dict[str, object] = {"__name__": "symbolic_engine"}

    def run(block: re.Match[str]) -> str:
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(compile(block[1], f"{PAGE.name}: {block[1][:40]!r}", "exec"), namespace)

        output = f"\n```text\n{said.getvalue()}```\n" if said.getvalue() else ""
        return f"```python\n{block[1]}```\n{output}"

    return BLOCK.sub(run, page)


def test_the_page_shows_what_its_code_prints() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert len(BLOCK.findall(page)) >= 10
    assert page.count("```text") >= 10
    assert renewed(page) == page


def test_the_example_goes_through_what_the_page_is_about() -> None:
    outputs = "".join(re.findall(r"```text\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL))
    for said in (
        "may be unfolded",
        "assumed: clear",
        "resting on",
        "costs the price of",
        "hits blue",
        "Solved",
    ):
        assert said in outputs


if __name__ == "__main__":
    PAGE.write_text(renewed(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
