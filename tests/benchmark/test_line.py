"""A line of results is looked at field by field: the first that is wrong is named."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tamp.benchmark.log import read_log
from tamp.errors import InputError
from tests.benchmark.toys import line, some

WRONG = [
    ("config", None, "'config' is None, not an object"),
    ("config.problem", 5, "'config.problem' is 5, not a name"),
    ("config.problem", "", "'config.problem' is ''"),
    ("config.problem", "a\x1b[2J", "'config.problem' is 'a"),
    ("config.sampler", None, "'config.sampler' is None"),
    ("config.sampler", ["a"], "'config.sampler' is ['a']"),
    ("config.seed", -1, "'config.seed' is -1, not a seed"),
    ("config.seed", 1.5, "'config.seed' is 1.5"),
    ("config.seed", True, "'config.seed' is True"),
    ("config.time", 0, "'config.time' is 0, not a time"),
    ("config.time", "30", "'config.time' is '30'"),
    ("config.algorithm", {}, "'config.algorithm' is {}"),
    ("config.samplers", [], "'config.samplers' is []"),
    ("seed", "0", "'seed' is '0'"),
    ("outcome", 3, "'outcome' is 3"),
    ("solved", 1, "'solved' is 1, not true or false"),
    ("verified", 0, "'verified' is 0"),
    ("planning_s", -1.0, "'planning_s' is -1.0"),
    ("planning_s", None, "'planning_s' is None"),
    ("planning_s", 10**400, "an integer of 401 digits"),
    ("planning_s", float("nan"), "NaN"),
    ("cpu_s", "x", "'cpu_s' is 'x'"),
    ("load", [], "'load' is []"),
    ("parts_s", -1, "'parts_s' is -1, not seconds by part"),
    ("parts_s", {"ik": "x"}, "'parts_s' is {'ik': 'x'}"),
    ("machine", None, "'machine' is None, not a machine"),
    ("machine", {"cpu": 1}, "'machine' is"),
    ("machine", {"cpu": "x"}, "'machine' is"),
    ("commit", {"a": None}, "'commit' is"),
    ("explanation", "text", "'explanation' is 'text'"),
    ("warnings", [1], "'warnings' is [1]"),
    ("streams", [], "'streams' is []"),
    ("samplers", {"on": 1}, "'samplers' is"),
    ("actions", 1.5, "'actions' is 1.5"),
    ("cost", "free", "'cost' is 'free'"),
    ("outcome", "TIMEOUT", "of a run that is solved"),
]


@pytest.mark.parametrize(("name", "value", "message"), WRONG, ids=range(len(WRONG)))
def test_a_field_that_is_wrong_is_named(
    name: str, value: object, message: str, tmp_path: Path
) -> None:
    path = tmp_path / "log.jsonl"
    good = line(
        some(1)[0],
        explanation=[],
        parts_s={"ik": 1.0},
        machine={"cpu": "x", "cores": 2},
        commit="abc",
    )
    bad = json.loads(json.dumps(good))
    *inside, last = name.split(".")
    (bad[inside[0]] if inside else bad)[last] = value
    path.write_text(f"{json.dumps(good)}\n{json.dumps(bad)}\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        read_log(path)
    assert str(caught.value).startswith(f"{path}:2: no result of tamp-bench: ")
    assert message in str(caught.value)
    assert str(caught.value).isprintable()


@pytest.mark.parametrize("name", ["config", "seed", "outcome", "solved", "verified", "planning_s"])
def test_a_field_that_is_missing_is_named(name: str, tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_text(
        json.dumps({n: v for n, v in line(some(1)[0]).items() if n != name}) + "\n",
        encoding="utf-8",
    )
    with pytest.raises(
        InputError, match=rf"log\.jsonl:1: no result of tamp-bench: '{name}' is missing"
    ):
        read_log(path)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"[" * 300_000 + b"\n", "nested too deeply"),
        (b'{"config": "' + b"x" * 3_000_000 + b'"}\n', "'seed' is missing"),
        ('{"\u00e9": 1}\n'.encode("latin-1"), "not UTF-8"),
        (b'{"a": 1, "a": 2}\n', "given twice"),
        (b'{"planning_s": 1e999}\n', "is missing"),
    ],
)
def test_a_hostile_line_is_one_error(content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "log.jsonl"
    path.write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_log(path)
    assert message in str(caught.value)
    assert len(str(caught.value)) < 1000
