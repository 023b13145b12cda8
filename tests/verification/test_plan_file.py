"""Malformed plan files are refused with the place of what is wrong, by our reader and by the published schema."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tamp.commands.verify import main
from tamp.errors import InputError
from tamp.plan.read import read_plan
from tamp.plan.sources import source_file
from tamp.system.files import shipped

Plan = dict[str, Any]
Write = Callable[[Any], Path]


def first_segment(plan: Plan) -> dict[str, Any]:
    return plan["actions"][0]["segments"][0]


MALFORMED: dict[str, tuple[Callable[[Plan], Any], str, bool]] = {
    # name: how to spoil it, a fragment of the message, whether a schema can say it
    "another format": (lambda p: p.update(format="other"), "tamp-plan", True),
    "no format": (lambda p: p.pop("format"), "tamp-plan", True),
    "another version": (lambda p: p.update(version=2), "version", True),
    "no actions": (lambda p: p.pop("actions"), "'actions' is missing", True),
    "actions a number": (lambda p: p.update(actions=3), "actions: an array is expected, not a number", True),
    "no sha256": (lambda p: p["inputs"]["domain"].pop("sha256"), "inputs.domain: 'sha256' is missing", True),
    "short sha256": (lambda p: p["inputs"]["domain"].update(sha256="ab"), "64 hexadecimal", True),
    "no problem": (lambda p: p["inputs"].pop("problem"), "'problem' is missing", True),
    "fact of nothing": (lambda p: p["initial"].append([]), "a fact needs a predicate", True),
    "fact of numbers": (lambda p: p["certified"].append(["pose", 3]), "a string is expected", True),
    "two coordinates": (lambda p: p["values"]["p1"].update(position=[0, 0]), "values.p1.position: 3 numbers", True),
    "no unit quaternion": (lambda p: p["values"]["p1"].update(quaternion=[0, 0, 0, 2]), "norm", False),
    "negative opening": (lambda p: p["values"]["g1"].update(opening=-0.1), "less than 0", True),
    "six joints": (lambda p: p["values"]["q1"]["lift"][1].pop(), "values.q1.lift[1]: 7 numbers", True),
    "no rows": (lambda p: p["values"]["q1"].update(approach=[]), "at least one row", True),
    "value without type": (lambda p: p["values"]["p1"].pop("type"), "'type' is missing", True),
    "value with type null": (lambda p: p["values"]["p1"].update(type=None), "'type' is null", True),
    "unknown part": (lambda p: first_segment(p).update(part="leg"), "'leg' is unknown", True),
    "no times": (lambda p: first_segment(p).update(times=[]), "at least one time", True),
    "a time too few": (lambda p: first_segment(p)["times"].pop(), "one a time", False),
    "text for a number": (lambda p: first_segment(p)["times"].append("1"), "a number is expected", True),
    "true for a number": (lambda p: p.update(cost=True), "a number is expected, not true or false", True),
    "unknown body in hand": (lambda p: first_segment(p).update(holding="ghost"), "unknown body 'ghost'", False),
    "grasp of a ghost": (lambda p: p["values"]["g1"].update(body="ghost"), "unknown body 'ghost'", False),
}  # fmt: skip


def schema_errors(root: Path, document: Any) -> list[Any]:
    jsonschema = pytest.importorskip("jsonschema")
    schema = json.loads((root / "tamp" / "plan" / "plan.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    return list(jsonschema.Draft202012Validator(schema).iter_errors(document))


def test_a_good_plan_is_read(plan: Plan, written: Write, root: Path) -> None:
    read = read_plan(written(plan))
    assert [action.name for action in read.actions] == ["move", "pick", "move", "place"]
    assert read.values["q1"].data[0].shape[1] == 7
    assert read.actions[1].segments[1].attach is not None
    assert schema_errors(root, plan) == []


@pytest.mark.parametrize("name", MALFORMED)
def test_a_malformed_plan_is_refused(plan: Plan, written: Write, root: Path, name: str) -> None:
    spoil, message, in_schema = MALFORMED[name]
    spoil(plan)
    with pytest.raises(InputError) as caught:
        read_plan(written(plan))
    assert message in str(caught.value)
    assert "plan.json" in str(caught.value)
    if in_schema:
        assert schema_errors(root, plan)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not JSON"),
        ("{", "plan.json:1:2: not JSON"),
        ("[1, 2]", "an object is expected"),
        ("null", "an object is expected"),
        ('{"format": NaN}', "NaN"),
        ('{"format": -Infinity}', "Infinity"),
        ('{"seed": 1, "seed": 2}', "'seed' is given twice"),
        ("[" * 100_000, "nested too deeply"),
    ],
)
def test_what_is_no_json_object_is_refused(text: str, message: str, written: Write) -> None:
    with pytest.raises(InputError) as caught:
        read_plan(written(text))
    assert message in str(caught.value)


def test_a_number_too_large_is_refused(plan: Plan, written: Write) -> None:
    text = json.dumps(plan).replace('"cost": 4.0', '"cost": 1e999')
    assert "1e999" in text
    with pytest.raises(InputError, match="finite"):
        read_plan(written(text))


def test_exit_codes(
    plan: Plan, written: Write, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    file = written(plan)
    assert main([str(file)]) == 0
    assert "plan.json holds: 4 actions" in capfd.readouterr().out
    assert main([str(file), "--quiet"]) == 0
    assert capfd.readouterr() == ("", "")
    plan["duration"] = 0.0
    assert main([str(written(plan)), "--json"]) == 1
    document = json.loads(capfd.readouterr().out)
    assert not document["holds"]
    assert document["violations"][0]["kind"] == "time"
    assert main([str(tmp_path / "absent.json")]) == 2
    message = capfd.readouterr().err
    assert "no such file" in message
    assert message.count("\n") == 1


def test_a_shipped_problem_and_domain_are_found_by_name(plan: Plan, written: Write) -> None:
    read = read_plan(written(plan))
    assert (
        source_file(read, "problem", Path("four_objects"))
        == shipped("problems") / "four_objects.yaml"
    )
    assert source_file(read, "domain", Path("cupboard")) == shipped("domains") / "cupboard.pddl"
    with pytest.raises(InputError, match=r"unknown problem 'four_object'.*four_objects"):
        source_file(read, "problem", Path("four_object"))


def test_files_are_looked_for_beside_the_plan(plan: Plan, written: Write, tmp_path: Path) -> None:
    problem = Path(plan["inputs"]["problem"]["path"])
    plan["inputs"]["problem"]["path"] = "/nowhere/by_hand.yaml"
    file = written(plan)
    assert main([str(file), "--quiet"]) == 2
    assert main([str(file), "--quiet", "--problem", str(problem)]) == 0
    (tmp_path / "by_hand.yaml").write_text(problem.read_text())
    assert main([str(file), "--quiet"]) == 0
    (tmp_path / "by_hand.yaml").write_text(problem.read_text() + "# changed\n")
    assert main([str(file), "--quiet"]) == 1


def test_unknown_objects_are_refused(
    plan: Plan, written: Write, capfd: pytest.CaptureFixture[str]
) -> None:
    plan["actions"][0]["arguments"][0] = "b7"
    assert main([str(written(plan))]) == 2
    assert "actions[0].arguments: unknown object 'b7'" in capfd.readouterr().err
