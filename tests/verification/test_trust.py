"""What a verdict rests on unchecked: which predicates, by which domain, by which streams."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from tamp.errors import InputError
from tamp.plan.read import PlanFile, PlanSource, TimedAction
from tamp.plan.sources import sha256
from tamp.symbolic.pddl.parser import parse_domain, parse_goal, parse_streams
from tamp.symbolic.pddl.structs import Domain, Fact, StreamFile
from tamp.system.files import shipped
from tamp.verification.trust import (
    certifiable,
    domain_note,
    other_files,
    read_streams,
    streams_file,
    trusted_relations,
)

DOMAIN = """
(define (domain d)
  (:requirements :adl :derived-predicates :typing)
  (:types thing movable pose)
  (:predicates (clean ?x - thing) (dry ?x - thing) (washed ?x - thing) (soaped ?x - thing)
    (neat ?x - thing) (movable ?x) (looked) (pose ?x - thing ?p - pose)
    (stood ?x - thing ?p - pose) (at-pose ?x - thing ?p - pose) (upright ?x - thing))
  (:action wash :parameters (?x - thing) :precondition (and (clean ?x) (movable ?x))
    :effect (and (washed ?x) (looked) (when (dry ?x) (looked))))
  (:action soap :parameters (?x - thing) :precondition (soaped ?x) :effect (washed ?x))
  (:derived (neat ?x - thing) (and (dry ?x) (not (soaped ?x))))
  (:derived (upright ?x - thing) (exists (?p - pose) (and (stood ?x ?p) (at-pose ?x ?p)))))
"""
STREAMS = """
(define (stream d)
  (:stream test-clean :inputs (?x) :domain (movable ?x) :certified (clean ?x))
  (:stream test-soaped :inputs (?x) :domain (movable ?x) :certified (soaped ?x))
  (:stream sample-upright :inputs (?x) :domain (movable ?x) :outputs (?p)
    :certified (and (pose ?x ?p) (stood ?x ?p))))
"""


@pytest.fixture
def domain() -> Domain:
    return parse_domain(DOMAIN)


@pytest.fixture
def streams(domain: Domain) -> StreamFile:
    return parse_streams(STREAMS, domain, None)


def plan_of(
    *,
    actions: Sequence[str] = (),
    initial: Sequence[Fact] = (),
    certified: Sequence[Fact] = (),
    sources: Sequence[PlanSource] = (),
    file: Path | None = None,
) -> PlanFile:
    timed = tuple(TimedAction(name, ("a",), 0.0, 0.0, 1.0, ()) for name in actions)
    return PlanFile(
        file, tuple(sources), "r", {"a": ("thing",)}, tuple(initial), "", {}, timed,
        tuple(certified), 0.0, 0.0,
    )  # fmt: skip


def trusted(
    domain: Domain,
    goal: str,
    streams: StreamFile | None = None,
    decided: Collection[str] = (),
    given: Collection[Fact] = (),
    **plan: Any,
) -> tuple[str, ...]:
    wanted = parse_goal(goal, domain, {"a": ("thing",)})
    return trusted_relations(plan_of(**plan), domain, wanted, streams, decided, given)


CLEAN, SOAPED, DRY = (("clean", "a"),), (("soaped", "a"),), (("dry", "a"),)


def test_what_only_the_plan_states_and_the_goal_asks_is_on_trust(domain: Domain) -> None:
    assert trusted(domain, "(clean a)", certified=CLEAN) == ("clean",)
    assert trusted(domain, "(clean a)", initial=CLEAN) == ("clean",)
    assert trusted(domain, "(clean a)") == ()  # nothing states it: it does not hold
    assert trusted(domain, "(dry a)", certified=CLEAN) == ()  # nobody asks


def test_what_the_problem_states_or_the_judge_decides_is_not_on_trust(domain: Domain) -> None:
    assert trusted(domain, "(clean a)", initial=CLEAN, given=CLEAN) == ()
    assert trusted(domain, "(clean a)", certified=CLEAN, decided={"clean"}) == ()


def test_what_must_not_hold_is_on_trust_where_streams_could_certify_it(
    domain: Domain, streams: StreamFile
) -> None:
    assert trusted(domain, "(not (soaped a))", streams) == ("soaped",)
    assert trusted(domain, "(not (dry a))", streams) == ()
    # without streams, what the plan states of others tells which could be certified
    assert trusted(domain, "(not (soaped a))") == ()
    assert trusted(domain, "(not (soaped a))", certified=(("soaped", "b"),)) == ("soaped",)


def test_only_actions_of_the_plan_count_with_their_conditions(domain: Domain) -> None:
    stated = CLEAN + SOAPED
    assert trusted(domain, "(and)", certified=stated) == ()
    assert trusted(domain, "(and)", certified=stated, actions=["wash"]) == ("clean",)
    assert trusted(domain, "(and)", certified=stated, actions=["soap", "wash"]) == (
        "clean",
        "soaped",
    )


def test_a_conditional_effect_rests_on_its_condition_both_ways(domain: Domain) -> None:
    """Whether it happens or not: something may ask for either."""
    assert trusted(domain, "(and)", certified=DRY, actions=["wash"]) == ("dry",)
    certifies = parse_streams(
        "(define (stream d) (:stream t :inputs (?x) :domain (movable ?x) :certified (dry ?x)))",
        domain,
        None,
    )
    assert trusted(domain, "(and)", certifies, actions=["wash"]) == ("dry",)


def test_rules_are_followed_with_their_signs(domain: Domain, streams: StreamFile) -> None:
    assert trusted(domain, "(neat a)", streams, certified=DRY) == ("dry", "soaped")
    assert trusted(domain, "(not (neat a))", streams, certified=SOAPED) == ("soaped",)
    assert trusted(domain, "(neat a)", certified=DRY) == ("dry",)


def test_fluents_types_and_kinds_are_never_on_trust(domain: Domain) -> None:
    stated = (("movable", "a"), ("washed", "a"), ("thing", "a"), ("neat", "a"))
    goal = "(and (washed a) (neat a) (= a a))"
    assert trusted(domain, goal, certified=stated, actions=["wash"]) == ()


def test_a_fact_about_poses_is_told_by_the_name_of_its_relation(
    domain: Domain, streams: StreamFile
) -> None:
    stated = (("stood", "a", "p"),)
    assert trusted(domain, "(upright a)", streams, certified=stated) == ("upright",)
    assert trusted(domain, "(upright a)", certified=stated) == ("stood",)


def test_certifiable_is_what_streams_certify_of_the_static(
    domain: Domain, streams: StreamFile
) -> None:
    assert certifiable(plan_of(), domain, streams) == {"clean", "soaped", "pose", "stood"}
    named = [PlanSource("streams", Path("s"), "")]
    static = {"clean", "soaped", "pose", "stood", "dry", "at-pose"}
    assert certifiable(plan_of(sources=named), domain, None) == static
    assert certifiable(plan_of(certified=(*CLEAN, ("washed", "a"))), domain, None) == {"clean"}


def source(role: str, file: Path, text: str | None = None) -> PlanSource:
    """The plan's word about a file, with another text's hash if one is given."""
    if text is None:
        return PlanSource(role, file, sha256(file))
    other = file.with_suffix(".other")
    other.write_text(text)
    return PlanSource(role, file, sha256(other))


def test_which_streams_are_read(tmp_path: Path) -> None:
    mine, beside = tmp_path / "mine.pddl", tmp_path / "mine.streams.pddl"
    assert streams_file(plan_of(), None, mine) is None
    beside.write_text(STREAMS)
    assert streams_file(plan_of(), None, mine) == beside
    assert streams_file(plan_of(), None) is None

    gone = PlanSource("streams", tmp_path / "gone" / "mine.streams.pddl", "")
    assert streams_file(plan_of(sources=[gone]), None, mine) is None
    plan = plan_of(sources=[gone], file=tmp_path / "plan.json")
    assert streams_file(plan, None) == beside  # of that name beside the plan

    other = tmp_path / "other.streams.pddl"
    other.write_text(STREAMS)
    assert streams_file(plan_of(sources=[source("streams", beside)]), other, mine) == other
    with pytest.raises(InputError, match="no such file"):
        streams_file(plan_of(), tmp_path / "none.pddl", mine)


def test_streams_that_changed_since_and_misfit_are_left_out(domain: Domain, tmp_path: Path) -> None:
    file = tmp_path / "d.streams.pddl"
    file.write_text(STREAMS)
    read = read_streams(plan_of(), file, domain)
    assert read is not None and next(one.name for one in read.streams) == "test-clean"
    assert read_streams(plan_of(), None, domain) is None

    file.write_text("(define (stream d) (:stream s :inputs (?x) :certified (unheard ?x)))")
    changed = plan_of(sources=[source("streams", file, STREAMS)])
    assert read_streams(changed, file, domain) is None
    for ours in (plan_of(), plan_of(sources=[source("streams", file)])):
        with pytest.raises(InputError, match="unheard"):
            read_streams(ours, file, domain)
    file.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="cannot be read"):
        read_streams(changed, file, domain)


def loaded(folder: Path, domain: str | None) -> Any:
    return SimpleNamespace(domain=domain, path=folder / "problem.yaml")


@pytest.fixture
def files(tmp_path: Path) -> tuple[Path, Path]:
    """The problem's domain and its streams."""
    mine, beside = tmp_path / "mine.pddl", tmp_path / "mine.streams.pddl"
    mine.write_text(DOMAIN)
    beside.write_text(STREAMS)
    return mine, beside


NOBODY: dict[str, Path | None] = {"domain": None, "streams": None}


def test_the_problems_own_files_are_no_others(files: tuple[Path, Path], tmp_path: Path) -> None:
    mine, beside = files
    plan = plan_of(sources=[source("streams", beside)])
    assert other_files(plan, loaded(tmp_path, "mine.pddl"), mine, beside, NOBODY) == ()
    assert other_files(plan, loaded(tmp_path, None), mine, beside, NOBODY) == ()


def test_another_domain_is_named(files: tuple[Path, Path], tmp_path: Path) -> None:
    mine, beside = files
    other = tmp_path / "other.pddl"
    other.write_text(DOMAIN + ";")
    plan = plan_of(sources=[source("streams", beside)])
    told = other_files(plan, loaded(tmp_path, "mine.pddl"), other, beside, NOBODY)
    assert told == ("by the domain other.pddl, not the problem's mine.pddl",)
    other.write_text(DOMAIN)  # a copy is the same
    assert other_files(plan, loaded(tmp_path, "mine.pddl"), other, beside, NOBODY) == ()
    told = other_files(plan, loaded(tmp_path, "gone.pddl"), mine, beside, NOBODY)
    assert told == ("by the domain mine.pddl; the problem's gone.pddl is not there",)


def test_other_streams_are_named(files: tuple[Path, Path], tmp_path: Path) -> None:
    mine, beside = files
    problem = loaded(tmp_path, "mine.pddl")
    changed = plan_of(sources=[source("streams", beside, "x")])
    (told,) = other_files(changed, problem, mine, beside, NOBODY)
    assert "mine.streams.pddl, which are not those that the plan was made with" in told
    (told,) = other_files(changed, problem, mine, None, NOBODY)
    assert told == "without the streams mine.streams.pddl, which are not there"
    assert other_files(plan_of(), problem, mine, None, NOBODY) == ()

    theirs = tmp_path / "theirs.streams.pddl"
    theirs.write_text(STREAMS + ";")
    with_theirs = plan_of(sources=[source("streams", theirs)])
    (told,) = other_files(with_theirs, problem, mine, theirs, NOBODY)
    assert told == "by the streams theirs.streams.pddl, not the problem's mine.streams.pddl"
    beside.unlink()
    (told,) = other_files(with_theirs, problem, mine, theirs, NOBODY)
    assert told == "by the streams theirs.streams.pddl, as the plan says"
    assert other_files(with_theirs, problem, mine, theirs, {**NOBODY, "streams": theirs}) == ()


def test_a_domain_that_only_the_plan_names_has_a_note(tmp_path: Path) -> None:
    mine = tmp_path / "mine.pddl"
    (told,) = domain_note(loaded(tmp_path, None), mine, given=False)
    assert told == "the problem names no domain; judged by mine.pddl, as the plan says"
    assert domain_note(loaded(tmp_path, "mine.pddl"), mine, given=False) == ()
    assert domain_note(loaded(tmp_path, None), mine, given=True) == ()
    assert domain_note(loaded(tmp_path, None), shipped("domains") / "cupboard.pddl", False) == ()
