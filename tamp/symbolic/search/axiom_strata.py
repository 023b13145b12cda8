"""Axioms over bits, by stratum: what the closure of a state goes through."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

from tamp.symbolic.pddl.structs import Fact
from tamp.symbolic.search.operators import Axiom


@dataclass(slots=True)
class AxiomStratum:
    """The axioms of one stratum, each under the lowest bit of its body."""

    watched: dict[int, list[tuple[int, int, int]]] = field(
        default_factory=dict[int, list[tuple[int, int, int]]]
    )
    free: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])
    mask: int = 0
    recursive: bool = False

    def axioms(self) -> Iterator[tuple[tuple[int, int], int]]:
        """Yield the axioms: what must hold and what must not, and the head."""
        for negative, head in self.free:
            yield (0, negative), head
        for watched in self.watched.values():
            for positive, negative, head in watched:
                yield (positive, negative), head


def axiom_strata(
    axioms: Sequence[Axiom], mask: Callable[[Iterable[Fact]], int]
) -> list[AxiomStratum]:
    """Sort the axioms, over bits, into their strata, the lowest first.

    Args:
        axioms: Stratified.
        mask: Gives the bits of facts.
    """
    strata: dict[int, AxiomStratum] = {}
    heads: dict[int, int] = {}
    for axiom in axioms:
        heads[axiom.stratum] = heads.get(axiom.stratum, 0) | mask((axiom.head,))
    for axiom in axioms:
        stratum = strata.setdefault(axiom.stratum, AxiomStratum())
        positive, negative = mask(axiom.positive), mask(axiom.negative)
        head = mask((axiom.head,))
        if positive:
            low = positive & -positive
            stratum.watched.setdefault(low, []).append((positive, negative, head))
            stratum.mask |= low
        else:
            stratum.free.append((negative, head))
        stratum.recursive = stratum.recursive or bool(positive & heads[axiom.stratum])
    return [strata[number] for number in sorted(strata)]
