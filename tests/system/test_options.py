"""Options from a command line: every mistake is one line that helps, and rules stand beside the fields."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import pytest
import tyro

from tamp.commands.execute import Execute
from tamp.commands.export import Export
from tamp.commands.solve_options import Arguments
from tamp.commands.verify import Verify
from tamp.commands.view import View
from tamp.errors import InputError
from tamp.system.options import Above, Between, OneOf, changed, check_rules, read_options


@dataclass(frozen=True)
class Note:
    """Something that an option says of itself."""

    text: str


@dataclass(frozen=True)
class Inner:
    """A group."""

    hand: Annotated[str, OneOf("hand", ("left", "right"))] = "left"
    """Which one."""
    loud: Annotated[bool, Note("not here")] = False
    """Whether."""


@dataclass(frozen=True)
class Outer:
    """Do something."""

    inner: tyro.conf.OmitArgPrefixes[Inner]
    time: Annotated[float, Above(0.0, "--time: not {value:g}")] = 1.0
    """How long."""
    jobs: Annotated[int, Between(1, 4, "--jobs: not {value}")] = 1
    """How many."""


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("--time 0", "--time: not 0"),
        ("--time nan", "--time: not nan"),
        ("--jobs 5", "--jobs: not 5"),
        ("--jobs 0", "--jobs: not 0"),
        ("--hand lefd", "unknown hand 'lefd'. Choices: left, right. Did you mean 'left'?"),
    ],
)
def test_a_rule_refuses_its_option_also_in_a_group(words: str, said: str) -> None:
    with pytest.raises(InputError) as error:
        check_rules(read_options(Outer, "try", words.split()))
    assert str(error.value) == said


@pytest.mark.parametrize("words", ["", "--time 1e-9 --jobs 4 --hand right", "--jobs=1"])
def test_what_no_rule_refuses_is_read(words: str) -> None:
    check_rules(read_options(Outer, "try", words.split()))


def test_only_options_that_were_changed_are_found_by_their_note() -> None:
    assert [*changed(Inner(), Note)] == []
    assert [*changed(Inner(hand="right", loud=True), Note)] == [("--loud", Note("not here"))]


@pytest.mark.parametrize(
    ("kind", "words", "meant"),
    [
        (Verify, "plan.json --sampel x", "--sampler"),
        (Export, "plan.json --formt csv", "--format"),
        (View, "one_object --no_browsr", "--no-browser"),
        (Execute, "plan.json --distrub x", "--disturb"),
        (Arguments, "one_object --heuristics ff", "--heuristic"),
        (Arguments, "one_object --vidoe=x.gif", "--video"),
    ],
)
def test_a_mistyped_option_is_told_what_was_meant(kind: type, words: str, meant: str) -> None:
    with pytest.raises(InputError, match=f"Did you mean '{meant}'") as error:
        read_options(kind, "try", words.split())
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("kind", [Verify, Export, View, Execute])
def test_what_is_missing_is_one_line(kind: type) -> None:
    with pytest.raises(InputError, match=r"^expected PLAN(\|PROBLEM)?: .*See try --help") as error:
        read_options(kind, "try", [])
    assert "\n" not in str(error.value)


def test_options_that_may_be_repeated() -> None:
    assert read_options(View, "try", ["one_object", "--at", "1", "--at", "2.5"]).at == (1.0, 2.5)
    assert read_options(Verify, "try", ["p", "--sampler", "a=x", "--sampler", "b=y"]).sampler == (
        "a=x",
        "b=y",
    )
