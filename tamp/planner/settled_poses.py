"""Settled poses: those at which the goal may leave a body, in the words of a domain that has
`settled`.

What the goal wants on, in or beside a body is put there when that is where it will stay. Put there
before, it would have to be put there again: a tower grows from below. A tray may be carried with
what is on it, and is loaded anywhere.
"""

from __future__ import annotations

from collections.abc import Collection

from tamp.planner.movable_places import PLACE_RELATIONS, PORTABLE
from tamp.symbolic.pddl.atoms import necessary_atoms
from tamp.symbolic.pddl.structs import Domain, Fact, Formula

SETTLED = "settled"
"""(settled ?o ?p): certified of the poses that are as the goal wants them."""

UNBOUND = "unbound"
"""(unbound ?o): the goal does not say where ?o is; it may stay anywhere."""

MEANT = "meant"
"""(meant ?o ?place): the goal wants ?o on or in this place."""

GOAL_PREDICATES = (SETTLED, UNBOUND, MEANT)
"""Predicates that speak of the goal, and not of the world."""


def settled_facts(
    domain: Domain,
    goal: Formula,
    movable: Collection[str],
    facts: Collection[Fact],
    wanted: Collection[Fact],
    now: bool,
) -> set[Fact]:
    """Say of which bodies the goal says where they are to be, and on or in which places.

    A body that it wants on some place, whichever, may stay anywhere: as far as the goal goes.

    Args:
        domain: The domain.
        goal: The goal; what all of it needs counts, not what may do instead of something else.
        movable: PDDL names of the bodies that move.
        facts: The initial facts.
        wanted: Relations of the user's own that are wanted, (R, o, ...), and propose where o is.
        now: Whether actions ask for such relations, too: then a body is wanted near another one
            before that is where it stays.
    """
    if not {*GOAL_PREDICATES} <= domain.predicates.keys():
        return set()
    bound: set[str] = set()
    found: set[Fact] = set()
    for atom in () if now else necessary_atoms(goal):
        words = (atom.predicate, *atom.terms)
        if atom.predicate in PLACE_RELATIONS and len(atom.terms) == 2:
            if words[1] in movable and not words[2].startswith("?"):
                found.add((MEANT, *atom.terms))
                bound.add(words[1])
        elif words in wanted:
            bound.add(words[1])
    loose = {name for name in movable if name not in bound or (PORTABLE, name) in facts}
    return found | {(UNBOUND, name) for name in loose}
