"""A learned relation in PDDL: its predicates, the rule that says when it holds, its streams."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

CARRIES = ("borne", "grounded", "sampled", "anchored")
"""Predicates of a domain whose movable bodies carry others, as `carriers` has them."""

PLACES = {"": "supported", "-inside": "contained"}
"""What is certified of a pose on a fixed surface and in a fixed container, by the stream's suffix.
"""

MOVABLE_PLACES = {"-on-movable": "stacked", "-inside-movable": "packed"}
"""The same of places of movable bodies."""


class Words:
    """The variables of a relation in PDDL.

    Args:
        name: Of the relation.
        kinds: Of its arguments: movable, fixed, surface, container.
        onto: What argument 0 rests on: 0 for the furniture, j for argument j, -j for the floor of
            argument j.
        tells: Whether it has a classifier; else what is proposed is taken to hold.
    """

    def __init__(self, name: str, kinds: Sequence[str], onto: int = 0, tells: bool = True) -> None:
        self.name, self.kinds, self.tells = name, tuple(kinds), tells
        letters = {"movable": "o", "fixed": "b", "surface": "s", "container": "c"}
        self.arguments = [
            f"?{letters[kind]}{index + 1 if index else ''}" for index, kind in enumerate(kinds)
        ]
        self.poses = {
            variable: f"?p{variable[2:]}"
            for variable, kind in zip(self.arguments, kinds, strict=True)
            if kind == "movable"
        }
        below = self.arguments[abs(onto)] if onto else ""
        self.below = below if below in self.poses else ""

    @property
    def typed(self) -> str:
        """Return the arguments with their types."""
        pairs = zip(self.arguments, self.kinds, strict=True)
        return " ".join(f"{variable} - {kind}" for variable, kind in pairs)

    @property
    def posed(self) -> str:
        """Return the arguments, each body followed by its pose."""
        return " ".join(
            f"{variable} {self.poses[variable]}" if variable in self.poses else variable
            for variable in self.arguments
        )

    @property
    def posed_typed(self) -> str:
        """Return the same with types."""
        said: list[str] = []
        for variable, kind in zip(self.arguments, self.kinds, strict=True):
            said.append(f"{variable} - {kind}")
            if variable in self.poses:
                said.append(f"{self.poses[variable]} - pose")
        return " ".join(said)

    @property
    def wanted(self) -> str:
        """Return the condition that the goal may want it of these arguments."""
        return f"(wanted-{self.name} {' '.join(self.arguments)})"

    @property
    def also(self) -> str:
        """Return the condition that the goal wants it of poses that another relation proposes."""
        return f"(also-{self.name} {' '.join(self.arguments)})"

    @property
    def certified(self) -> str:
        """Return what its generator says of a pose."""
        said = f"proposed-{self.name}" if self.tells else f"{self.name}-pose"
        return f"({said} {self.posed})"


def domain_parts(words: Words) -> tuple[list[str], list[str]]:
    """Return the lines of the predicates, and those of the rule."""
    name = words.name
    predicates = [
        f"(wanted-{name} {words.typed})  ; the planner says of which the goal may want it",
        *([f"(also-{name} {words.typed})"] if words.tells and len(words.poses) > 1 else []),
        *([f"(proposed-{name} {words.posed_typed})"] if words.tells else []),
        f"({name}-pose {words.posed_typed})",
        f"({name} {words.typed})",
    ]
    poses = " ".join(f"{pose} - pose" for pose in words.poses.values())
    there = " ".join(f"(at-pose {body} {pose})" for body, pose in words.poses.items())
    rule = [
        f"(:derived ({name} {words.typed})",
        f"  (exists ({poses}) (and ({name}-pose {words.posed}) {there})))",
    ]
    return predicates, rule


def stream_parts(words: Words, carries: bool) -> list[str]:
    """Return the lines of its streams.

    The generator certifies what the pose rests on, as those of `on` and `inside` do, so that other
    bodies may be related to this one where it will be. Where the other arguments stand on a
    surface, in a container, or on a body that moves, these are several streams.

    Args:
        words: The relation.
        carries: Whether the domain knows what movable bodies carry.
    """
    name = words.name
    lines = [line for one in _generators(words, carries) for line in one.lines(words)]
    if not words.tells:
        return [*lines, *_settling(words)]

    proposed = words.certified
    if len(words.kinds) == 1:
        proposed = f"(and (pose {words.posed}) {words.wanted})"
    lines += [
        f"(:stream test-{name}",
        f"  :inputs ({words.posed}) :domain {proposed}",
        f"  :certified ({name}-pose {words.posed}))",
    ]
    if len(words.poses) > 1:
        poses = [f"(settled {body} {pose})" for body, pose in words.poses.items()]
        lines += [
            f"(:stream test-{name}-also",
            f"  :inputs ({words.posed})",
            f"  :domain {_all([words.also, *poses])}",
            f"  :certified ({name}-pose {words.posed}))",
        ]
    return [*lines, *_settling(words)]


def settled_parts(supports: Sequence[str]) -> tuple[list[str], list[str]]:
    """Return the lines of predicates, and of streams, by which a domain is told where the goal may
    leave bodies.

    Args:
        supports: Predicates of what a pose rests on, (supported ?o ?p ?place), as it has them.
    """
    predicates = [
        "; of the goal: it leaves open where ?o is; it wants ?o on or in this place; where it may",
        "(unbound ?o - movable)",
        "(meant ?o - movable ?s - object)",
        "(settled ?o - movable ?p - pose)",
    ]
    conditions = [
        "(unbound ?o) (pose ?o ?p)",
        *(f"(meant ?o ?s) ({one} ?o ?p ?s)" for one in supports),
    ]
    streams = [
        f"(:rule :inputs (?o ?p{' ?s' if '?s' in one else ''}) :domain (and {one}) "
        ":certified (settled ?o ?p))"
        for one in conditions
    ]
    return predicates, [
        "; where the goal may leave a body: only there others are put beside it",
        *streams,
    ]


def _settling(words: Words) -> list[str]:
    """Return the rule that argument 0 may stay where the relation holds as the goal wants it."""
    body, pose = words.arguments[0], words.poses[words.arguments[0]]
    holds = f"({words.name}-pose {words.posed})"
    return [
        f"(:rule :inputs ({words.posed})",
        f"  :domain (and {words.wanted} {holds})",
        f"  :certified (settled {body} {pose}))",
    ]


@dataclass(frozen=True)
class _Generator:
    """A stream that samples poses of argument 0.

    Attributes:
        suffix: Of its name.
        inputs: Its variables.
        domain: Its conditions.
        certified: What it says of the pose, beside that it is one and that the relation is meant.
    """

    suffix: str
    inputs: tuple[str, ...]
    domain: tuple[str, ...]
    certified: tuple[str, ...]

    def lines(self, words: Words) -> list[str]:
        """Return its lines."""
        first = words.arguments[0]
        pose = words.poses[first]
        certified = [f"(pose {first} {pose})", *self.certified, words.certified]
        return [
            f"(:stream sample-{words.name}{self.suffix}",
            f"  :inputs ({' '.join(self.inputs)})",
            f"  :domain {_all(self.domain)}",
            "  :fluents (at-pose)",
            f"  :outputs ({pose}) :certified {_all(certified)})",
        ]


def _generators(words: Words, carries: bool) -> list[_Generator]:
    first, others = words.arguments[0], words.arguments[1:]
    pose = words.poses[first]
    inputs = (first, *(one for name in others for one in (name, *_pose(words, name))))
    posed = [name for name in others if name in words.poses]

    if words.below:
        conditions = [words.wanted, *_settled(words, posed)]
        resting = f"(borne {first} {pose} {words.below} {words.poses[words.below]})"
        return [_Generator("", inputs, tuple(conditions), (resting, f"(sampled {first} {pose})"))]

    place = next((name for name in others if name[1] in "sc"), "")
    also = (f"(grounded {first} {pose})", f"(sampled {first} {pose})") if carries else ()
    if place or not posed:
        place, fact = place or "?s", "contained" if place[1:2] == "c" else "supported"
        kind = "container" if fact == "contained" else "surface"
        conditions = [
            words.wanted,
            f"({kind} {place})",
            *([f"(anchored {place})"] if carries else []),
        ]
        conditions += [f"({fact} {name} {words.poses[name]} {place})" for name in posed]
        conditions += _settled(words, posed)
        inputs = inputs if place in inputs else (*inputs, place)
        return [
            _Generator("", inputs, tuple(conditions), (f"({fact} {first} {pose} {place})", *also))
        ]

    found: list[_Generator] = []
    for suffix, fact in PLACES.items() if words.tells else [("", "supported")]:
        place = "?c" if fact == "contained" else "?s"
        there = tuple(f"({fact} {name} {words.poses[name]} {place})" for name in posed)
        resting = f"({fact} {first} {pose} {place})"
        found.append(
            _Generator(
                suffix,
                (*inputs, place),
                (words.wanted, *there, *_settled(words, posed)),
                (resting, *also),
            )
        )
    for suffix, fact in MOVABLE_PLACES.items() if words.tells and carries else ():
        place = "?c" if fact == "packed" else "?s"
        below = f"{place} ?below ?pb"
        there = tuple(f"({fact} {name} {words.poses[name]} {below})" for name in posed)
        resting = (f"({fact} {first} {pose} {below})", f"(borne {first} {pose} ?below ?pb)")
        found.append(
            _Generator(
                suffix,
                (*inputs, place, "?below", "?pb"),
                (words.wanted, *there, *_settled(words, posed)),
                (*resting, f"(sampled {first} {pose})"),
            )
        )
    return found


def _settled(words: Words, names: Sequence[str]) -> list[str]:
    return [f"(settled {name} {words.poses[name]})" for name in names]


def _pose(words: Words, name: str) -> tuple[str, ...]:
    return (words.poses[name],) if name in words.poses else ()


def _all(conditions: Sequence[str]) -> str:
    return conditions[0] if len(conditions) == 1 else f"(and {' '.join(conditions)})"
