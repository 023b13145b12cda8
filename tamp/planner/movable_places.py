"""Movable places: surfaces and containers of movable bodies, in the words of a domain that has
`stackable`.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from itertools import permutations

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem
from tamp.geometric.loading.tops import top_of
from tamp.geometric.scene.scene import Body, Hull, Scene
from tamp.symbolic.pddl.structs import (
    And,
    Atom,
    Domain,
    Exists,
    Fact,
    Forall,
    Formula,
    Not,
    Or,
)

STACKABLE = "stackable"
"""(stackable ?o ?place ?below): ?o may be put on or into a place of the movable body ?below."""

ANCHORED = "anchored"
"""(anchored ?place): the place is a fixed body's."""

PORTABLE = "portable"
"""(portable ?o): the goal wants ?o somewhere, and it may be carried there with what is on it."""

MIN_PLACE_WIDTH_M = 0.02
"""Metres: nothing is stacked on a top that is narrower."""

WANTED = "wanted-"
"""(wanted-R ?o ?o2): the goal, or an action, may want R of these; only then is it sampled."""

PLACE_RELATIONS = ("on", "inside")
"""Those whose second argument is a place."""


def carries(domain: Domain) -> bool:
    """Tell whether a domain knows places of movable bodies."""
    return STACKABLE in domain.predicates


def with_tops(scene: Scene) -> Scene:
    """Return the scene in which each movable body without places has its flat top as a surface of
    its own name.

    Only shapes whose top is certain have one: several hulls of a mesh may span air, as over a cup.
    """
    bodies = {name: _topped(body) for name, body in scene.bodies.items()}
    return replace(scene, bodies=bodies)


def _topped(body: Body) -> Body:
    declared = body.surfaces or body.cavities or body.bare
    hulls = sum(isinstance(part.shape, Hull) for part in body.parts)
    if not body.movable or declared or (hulls and len(body.parts) > 1):
        return body
    top = top_of(body.name, body.parts, body.pose)
    if top is None or min(top.size) < MIN_PLACE_WIDTH_M:
        return body
    return replace(body, surfaces=(top,))


def place_facts(scene: Scene, domain: Domain, goal: Formula) -> set[Fact]:
    """Say which places are fixed, and what the goal may want on the others.

    A goal that names its bodies and places allows those pairs alone: every further pair would
    multiply the poses that there may be. Whatever is in the way is put onto fixed places.
    """
    places = {**scene.surfaces, **scene.cavities}
    facts: set[Fact] = {
        (ANCHORED, name.lower())
        for name, place in places.items()
        if not scene.bodies[place.body].movable
    }
    below = {
        name.lower(): place.body.lower()
        for name, place in places.items()
        if scene.bodies[place.body].movable
    }

    bodies, going = {name.lower() for name in scene.movable}, set[str]()
    for body, place in _wanted(goal, domain):
        goes = bodies & {body} if body is not None else bodies
        going |= goes
        facts |= {
            (STACKABLE, one, other, below[other])
            for one in goes
            for other in (below.keys() & {place} if place is not None else below)
            if one != below[other]
        }

    wanted = {(fact[1], fact[3]) for fact in facts if fact[0] == STACKABLE}
    return facts | {(PORTABLE, one) for one in going if _is_tray(one, wanted, scene)}


def _is_tray(body: str, wanted: Collection[tuple[str, str]], scene: Scene) -> bool:
    """Check whether carrying a body with what is on it may be worth it: several bodies are wanted
    there, or one that is there.

    A base of a tower is put down first: each body that could ride multiplies the poses.
    """
    on_it = [one for one, below in wanted if below == body]
    there = {
        name.lower()
        for name in scene.movable
        if body in map(str.lower, scene.bodies[name].carriers)
    }
    return len(on_it) > 1 or bool(there.intersection(on_it))


def _wanted(goal: Formula, domain: Domain) -> Iterator[tuple[str | None, str | None]]:
    """Yield bodies and places that a goal relates; None for any."""
    for atom in _atoms(goal):
        if atom.predicate in PLACE_RELATIONS and len(atom.terms) == 2:
            body, place = (None if term.startswith("?") else term for term in atom.terms)
            yield body, place
        elif WANTED + atom.predicate in domain.predicates:
            continue  # its own stream puts bodies where it holds
        elif atom.predicate in domain.derived_predicates:
            # A rule of the user's own is not looked through: any two of its arguments are meant.
            terms = [None if term.startswith("?") else term for term in atom.terms]
            yield from permutations(terms, 2)


def _atoms(formula: Formula) -> Iterator[Atom]:
    match formula:
        case Atom():
            yield formula
        case Not(body) | Exists(_, body) | Forall(_, body):
            yield from _atoms(body)
        case And(parts) | Or(parts):
            for part in parts:
                yield from _atoms(part)


def remedied(error: InputError, domain: Domain) -> InputError:
    """Name the domain that knows places of movable bodies where one is wanted without it."""
    if carries(domain) or error.remedy or "is a movable, not a" not in error.message:
        return error
    return InputError(
        error.message, file=error.file, line=error.line, column=error.column,
        choices=error.choices, remedy="In 'domain: carriers' movable bodies carry others",
    )  # fmt: skip


def check_circle(loaded: LoadedProblem, goal: Formula) -> None:
    """Check that a goal does not want bodies on each other in a circle.

    Raises:
        InputError: It does, with the bodies.
    """
    chain = circle(goal, loaded.scene)
    if chain:
        what = f"the goal wants bodies on each other in a circle: {' on '.join(chain)}"
        raise InputError(what, file=loaded.path, line=loaded.goal.line)


def circle(goal: Formula, scene: Scene) -> tuple[str, ...]:
    """Find bodies that a conjunctive goal wants on or in each other in a circle; none is empty."""
    owner = {
        place.name.lower(): place.body.lower()
        for place in (*scene.surfaces.values(), *scene.cavities.values())
    }
    below: dict[str, set[str]] = {}
    parts: Collection[Formula] = goal.parts if isinstance(goal, And) else (goal,)
    for part in parts:
        if isinstance(part, Atom) and part.predicate in PLACE_RELATIONS and len(part.terms) == 2:
            body, place = part.terms
            below.setdefault(body, set()).add(owner.get(place, place))

    for start in below:
        chain = _back_to(start, below)
        if chain:
            return chain
    return ()


def _back_to(start: str, below: dict[str, set[str]]) -> tuple[str, ...]:
    waiting: list[tuple[str, ...]] = [(start,)]
    seen: set[str] = set()
    while waiting:
        chain = waiting.pop()
        for under in sorted(below.get(chain[-1], ())):
            if under == start:
                return (*chain, start)
            if under not in seen:
                seen.add(under)
                waiting.append((*chain, under))
    return ()
