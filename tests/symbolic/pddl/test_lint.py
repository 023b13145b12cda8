from __future__ import annotations

from tamp.symbolic.pddl.lint import lint
from tamp.symbolic.pddl.parser import parse_domain, parse_streams, parse_task

DOMAIN = """\
(define (domain kitchen)
  (:predicates (at ?x ?p) (hot ?x) (pose ?p) (kin ?p ?q) (seen ?x)
               (spare ?x) (clean ?x))
  (:action heat :parameters (?x ?p ?q) :precondition (and (at ?x ?p) (kin ?p ?q)) :effect (hot ?x))
  (:action wipe :parameters (?x) :effect (clean ?x)))
"""

STREAMS = """\
(define (stream kitchen)
  (:stream sample :outputs (?p) :certified (pose ?p))
  (:stream reach :inputs (?p) :domain (pose ?p) :outputs (?q ?t) :certified (kin ?p ?q))
  (:stream look :inputs (?p) :domain (pose ?p) :certified (seen ?p)))
"""

PROBLEM = """\
(define (problem dinner) (:domain kitchen)
  (:objects soup table)
  (:init (at soup table))
  (:goal (and (hot soup) (seen soup)
              (spare soup) (at soup soup) (at soup table) (not (spare table)))))
"""


def test_every_oddity_has_its_place() -> None:
    domain = parse_domain(DOMAIN, "d.pddl")
    streams = parse_streams(STREAMS, domain, "s.pddl")
    task = parse_task(PROBLEM.replace("(seen soup)", ""), domain, "p.pddl")
    assert lint(domain, streams, task.goal, task.initial) == (
        "p.pddl:5:15: goal (spare soup): no action, rule or stream makes 'spare' true",
        "p.pddl:5:28: goal (at soup soup): no action, rule or stream makes 'at' true",
        "s.pddl:3:3: output ?t of stream 'reach' is never certified: no action can use it",
        "s.pddl:4:3: stream 'look' is never used: nothing asks for (seen ...)",
    )


def test_a_goal_may_ask_for_what_a_stream_certifies() -> None:
    domain = parse_domain(DOMAIN, "d.pddl")
    streams = parse_streams(STREAMS, domain, "s.pddl")
    task = parse_task(PROBLEM, domain, "p.pddl")
    assert not [
        text
        for text in lint(domain, streams, task.goal, task.initial)
        if "look" in text or "seen" in text
    ]


def test_a_domain_alone() -> None:
    assert lint(parse_domain(DOMAIN, "d.pddl")) == (
        "d.pddl:2:36: predicate 'pose' is never used",
        "d.pddl:2:58: predicate 'seen' is never used",
        "d.pddl:3:16: predicate 'spare' is never used",
    )


def test_shipped_domains_are_clean(root: object) -> None:
    from tamp.system.files import shipped

    domains = [
        path for path in sorted(shipped("domains").glob("*.pddl")) if ".streams" not in path.name
    ]
    assert domains
    for path in domains:
        domain = parse_domain(path.read_text(encoding="utf-8"), path)
        beside = path.with_suffix(".streams.pddl")
        assert lint(domain, parse_streams(beside.read_text(encoding="utf-8"), domain, beside)) == ()
