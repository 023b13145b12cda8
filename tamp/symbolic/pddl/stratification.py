"""Stratification: the order in which derived predicates can be evaluated."""

from __future__ import annotations

from collections.abc import Sequence

from tamp.symbolic.pddl.atoms import signed_atoms
from tamp.symbolic.pddl.nodes import error
from tamp.symbolic.pddl.structs import Atom, Derived, Place


def strata(rules: Sequence[Derived]) -> dict[str, int]:
    """Compute the stratum of every derived predicate, counted from 0.

    A predicate stands no lower than those it rests on, and above those whose negation it rests on:
    with the strata below complete, what is not derived is false (Thiébaux, Hoffmann, Nebel: In
    Defense of PDDL Axioms, 2005).

    Raises:
        InputError: When a predicate rests on its own negation, at that negation.
    """
    levels = {rule.head.predicate: 0 for rule in rules}
    uses = [
        (rule.head.predicate, atom, positive)
        for rule in rules
        for atom, positive in signed_atoms(rule.body)
    ]
    uses = [use for use in uses if use[1].predicate in levels]
    # Levels only rise; one that exceeds the number of predicates rises for ever.
    changed = True
    while changed:
        changed = False
        for head, atom, positive in uses:
            level = levels[atom.predicate] + (0 if positive else 1)
            if level > levels[head]:
                levels[head] = level
                changed = True
        if any(level >= len(levels) for level in levels.values()):
            raise _cyclic(uses)
    return levels


def _cyclic(uses: Sequence[tuple[str, Atom, bool]]) -> Exception:
    """Make the error at the first negation that lies on a cycle.

    The graph is networkx's, which takes 0.1 s to import: that is for errors only. Strata themselves
    are computed above for each domain that is read, and need no graph.
    """
    import networkx as nx

    depends_on = nx.DiGraph((head, atom.predicate) for head, atom, _ in uses)
    for head, atom, positive in uses:
        if positive or not nx.has_path(depends_on, atom.predicate, head):
            continue
        way = nx.shortest_path(  # pyright: ignore[reportUnknownMemberType]
            depends_on, atom.predicate, head
        )
        place = atom.place or Place(None, 1, 1)
        cycle = " rests on ".join((head, f"not {way[0]}", *way[1:]))
        return error(place, f"derived predicate '{head}' rests on its own negation: {cycle}")
    raise ValueError("no negation lies on a cycle")
