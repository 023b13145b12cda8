"""The verdict says what it rests on that could not be checked, and the judge asks the classifiers that it is given."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import tamp
from tamp.commands.verify import main
from tamp.geometric.samplers.python_file import python_grounding
from tamp.verification.verify import verify
from tests.own import PYTHON, SAMPLED, Proposing, write_domain, write_problem

Written = Callable[..., Path]


@pytest.fixture
def written(root: Path, tmp_path: Path) -> Written:
    """Makes a plan file for a goal; the classifier is in upright.py beside it."""
    write_domain(root, tmp_path, SAMPLED)
    (tmp_path / "upright.py").write_text(PYTHON)

    def write(goal: str, *, domain: str | None = None, streams: Path | None = None) -> Path:
        problem = tamp.load_problem(
            write_problem(tmp_path, goal),
            domain,
            streams=streams,
            groundings={"upright": python_grounding(tmp_path / "upright.py")},
        )
        return tamp.write_plan(tamp.solve(problem, max_time=60.0, seed=0), tmp_path / "plan.json")

    return write


def changed(plan: Path, **entries: Any) -> Path:
    document = json.loads(plan.read_text())
    plan.write_text(json.dumps({**document, **entries}))
    return plan


def ask(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    code = main(list(words))
    said = capsys.readouterr()
    return code, said.out + said.err


def test_strict_wants_the_classifier(written: Written, capsys: pytest.CaptureFixture[str]) -> None:
    plan = written("(upright tea table)")
    sampler = ["--sampler", f"upright={plan.parent / 'upright.py'}"]
    code, said = ask(capsys, str(plan))
    assert code == 0 and said.startswith("plan.json holds, on trust: upright: 0 actions")
    code, said = ask(capsys, str(plan), "--strict")
    assert (
        code == 1
        and "plan.json holds, on trust: upright" in said
        and "not accepted, for --strict" in said
    )
    code, said = ask(capsys, str(plan), "--strict", "--json")
    found = json.loads(said)
    assert code == 1 and found["holds"] and found["on_trust"] == ["upright"]
    assert not found["checked"] and not found["accepted"] and found["trusted"] == {"stood": 1}
    code, said = ask(capsys, str(plan), "--strict", *sampler)
    assert code == 0 and said.startswith("plan.json holds: 0 actions") and "upright asked" in said
    code, said = ask(capsys, str(plan), "--strict", "--json", *sampler)
    found = json.loads(said)
    assert code == 0 and found["accepted"] and found["checked"] and found["asked"]["upright"] == 4
    assert ask(capsys, str(plan), "--strict", "--quiet") == (1, "")


def test_a_false_fact_is_found_by_the_classifier_only(
    written: Written, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nobody but the plan says that the milk stands, which lies."""
    plan = written("(upright tea table)")
    document = json.loads(plan.read_text())
    (plan.parent / "mine.yaml").write_text(
        (plan.parent / "mine.yaml").read_text().replace("upright tea", "upright milk")
    )
    told = written("(upright milk shelf)")
    other = json.loads(told.read_text())
    problem = write_problem(plan.parent, "(upright milk table)")
    document["goal"] = "(upright milk table)"
    document["initial"].append(["stood", "milk", "milk_start", "table"])
    document["inputs"] = {**other["inputs"], "problem": other["inputs"]["problem"]}
    from tamp.plan.sources import sha256

    document["inputs"]["problem"] = {"path": str(problem), "sha256": sha256(problem)}
    plan.write_text(json.dumps(document))
    code, said = ask(capsys, str(plan))
    assert code == 0 and "holds, on trust: upright" in said, said
    code, said = ask(capsys, str(plan), "--sampler", f"upright={plan.parent / 'upright.py'}")
    assert code == 1, said
    assert (
        "(stood milk milk_start table) does not hold: the classifier of 'upright' denies it" in said
    )
    assert "(upright milk table) does not follow from the facts at the end" in said


def test_a_fact_left_out_is_found_as_well(
    written: Written, capsys: pytest.CaptureFixture[str]
) -> None:
    """Nothing is said of the tea, which stands; so that it does not stand is taken on trust."""
    plan = written("(not (upright milk table))")
    problem = write_problem(plan.parent, "(not (upright tea table))")
    document = json.loads(plan.read_text())
    initial = [fact for fact in document["initial"] if fact[0] != "stood"]
    from tamp.plan.sources import sha256

    inputs = {**document["inputs"], "problem": {"path": str(problem), "sha256": sha256(problem)}}
    changed(plan, goal="(not (upright tea table))", initial=initial, inputs=inputs)
    code, said = ask(capsys, str(plan))
    assert code == 0 and "holds, on trust: upright" in said, said
    code, said = ask(capsys, str(plan), "--sampler", f"upright={plan.parent / 'upright.py'}")
    assert (
        code == 1 and "(not (upright tea table)) does not follow from the facts at the end" in said
    ), said


def test_only_what_the_verdict_rests_on_is_named(written: Written) -> None:
    assert verify(written("(on tea shelf)")).checked


def test_without_the_streams_the_predicate_is_named(written: Written) -> None:
    plan = written("(upright tea table)")
    (plan.parent / "mine.streams.pddl").unlink()
    report = verify(plan)
    assert report.holds and report.on_trust == ("stood",)
    assert report.other_files == ("without the streams mine.streams.pddl, which are not there",)
    with pytest.raises(tamp.InputError, match="Give them: --streams FILE"):
        verify(plan, classifiers={"upright": python_grounding(plan.parent / "upright.py")})


def test_another_domain_and_other_streams_are_named(
    root: Path, written: Written, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    easy = write_domain(root, tmp_path, SAMPLED, name="easy")
    easy.write_text(easy.read_text().replace("(not (loaded ?o)) ", ""))
    plan = written("(on tea shelf)", domain=str(easy))
    code, said = ask(capsys, str(plan))
    assert (
        code == 0
        and "plan.json holds, by the domain easy.pddl, not the problem's mine.pddl" in said
    ), said
    assert ask(capsys, str(plan), "--strict", "--quiet")[0] == 1
    assert verify(written("(on tea shelf)")).checked

    other = tmp_path / "other.streams.pddl"
    other.write_text((tmp_path / "mine.streams.pddl").read_text() + "; of another opinion\n")
    plan = written("(on tea shelf)", streams=other)
    assert verify(plan).other_files == (
        "by the streams other.streams.pddl, not the problem's mine.streams.pddl",
    )
    other.write_text(other.read_text() + "; and now of another one\n")
    assert "not those that the plan was made with" in verify(plan).other_files[0]
    mine = tmp_path / "mine.streams.pddl"
    assert "not those that the plan was made with" in verify(plan, streams=mine).other_files[0]


def test_a_plan_that_names_no_streams_states_no_more_than_the_problem(
    root: Path, written: Written
) -> None:
    """A fact that no stream certifies, and the problem does not state, is wrong as it ever was."""
    plan = written("(upright tea table)")
    document = json.loads(plan.read_text())
    del document["inputs"]["streams"]
    changed(plan, inputs=document["inputs"])
    assert verify(plan).on_trust == ("upright",)  # those beside the domain
    changed(
        plan,
        initial=[*document["initial"], ["reachable", "milk", "milk_start"], ["loaded", "milk"]],
    )
    assert any("does not imply (loaded milk)" in one.message for one in verify(plan).violations)
    (plan.parent / "mine.streams.pddl").unlink()
    assert any("does not imply (stood tea" in one.message for one in verify(plan).violations)


def test_a_problem_without_a_domain_has_a_note(
    root: Path, written: Written, tmp_path: Path
) -> None:
    written("(on tea shelf)")
    path = tmp_path / "mine.yaml"
    path.write_text(path.read_text().replace("domain: mine.pddl\n", ""))
    upright = python_grounding(tmp_path / "upright.py")
    problem = tamp.load_problem(path, tmp_path / "mine.pddl", groundings={"upright": upright})
    plan = tamp.write_plan(tamp.solve(problem, max_time=60.0, seed=0), tmp_path / "plan.json")
    report = verify(plan)
    assert report.checked and report.notes == (
        "the problem names no domain; judged by mine.pddl, as the plan says",
    )
    assert verify(plan, domain=tmp_path / "mine.pddl").notes == ()


@pytest.mark.parametrize(
    ("sampler", "message"),
    [
        ("upright", "--sampler wants RELATION=FILE"),
        ("upright=gone.py", "no such file"),
        ("upright=transfer", "the judge knows no sampler 'transfer'"),
        ("upright=empty.py", "no object 'grounding' with the method classify"),
        ("on=upright.py", "'on' is decided by the bodies' geometry"),
        ("uprigth=upright.py", "the streams have no relation 'uprigth'"),
        ("upright=gone.safetensors", "no such weight file"),
    ],
)
def test_what_is_wrong_with_a_classifier(
    sampler: str,
    message: str,
    written: Written,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    plan = written("(upright tea table)")
    monkeypatch.chdir(plan.parent)
    Path("empty.py").write_text("")
    code, said = ask(capsys, "plan.json", "--sampler", sampler)
    assert code == 2 and message in said, said


class Silent:
    """Cannot tell of anything."""

    def classify(self, scene: tamp.Scene, arguments: object) -> float:
        return float("nan")


def test_one_that_cannot_tell_is_no_check(written: Written) -> None:
    report = verify(written("(upright tea table)"), classifiers={"upright": Silent()})
    assert report.holds and report.on_trust == ("upright",)
    assert any("it cannot tell of (upright " in note for note in report.notes)


def test_what_a_plan_makes_true_needs_no_classifier_and_is_on_trust(
    root: Path, tmp_path: Path
) -> None:
    write_domain(root, tmp_path, SAMPLED, actions="")
    (tmp_path / "upright.py").write_text(PYTHON)
    upright = python_grounding(tmp_path / "upright.py")
    problem = tamp.load_problem(
        write_problem(tmp_path, "(upright milk shelf)"), groundings={"upright": Proposing(upright)}
    )
    plan = tamp.write_plan(tamp.solve(problem, max_time=60.0, seed=0), tmp_path / "plan.json")
    assert verify(plan).on_trust == ("upright",)
    report = verify(plan, classifiers={"upright": upright})  # type: ignore[dict-item]
    assert report.holds and report.checked
