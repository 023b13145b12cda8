"""The tolerances: said alike in the help, in the documentation and by the judge."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.commands.verify import main
from tamp.verification.replay import LOOKS_BEYOND, MAX_STATES_AT_FIRST
from tamp.verification.tolerances import tolerances


def test_the_tolerances_are_said_in_the_help_and_in_the_documentation(
    root: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as end:
        main(["--help"])
    assert not end.value.code
    said, written = (
        capsys.readouterr().out,
        (root / "docs" / "how-it-works.md").read_text(encoding="utf-8"),
    )
    rows = tolerances()
    assert len(rows) > 8
    for what, much in rows:
        assert what in said and much in said
        assert f"| {what} | {much} |" in written
    assert f"{MAX_STATES_AT_FIRST:,} states" in written and f"{LOOKS_BEYOND:,}" in written
