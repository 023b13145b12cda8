"""An index of facts by predicate and terms, and joins over them."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence

from tamp.symbolic.pddl.structs import Atom, Fact


class FactIndex:
    """Facts by predicate, and by predicate, position and object."""

    def __init__(self) -> None:
        self._by_predicate: dict[str, list[Fact]] = defaultdict(list)
        self._by_object: dict[tuple[str, int, str], list[Fact]] = defaultdict(list)

    def add(self, fact: Fact) -> None:
        """Add a fact that is not there yet."""
        self._by_predicate[fact[0]].append(fact)
        for position in range(1, len(fact)):
            self._by_object[(fact[0], position, fact[position])].append(fact)

    def join(self, atoms: Sequence[Atom], binding: dict[str, str]) -> Iterator[dict[str, str]]:
        """Yield all extensions of the binding under which every atom is a known fact."""
        if not atoms:
            yield binding
            return
        candidates = [self._candidates(atom, binding) for atom in atoms]
        first = min(range(len(atoms)), key=lambda i: len(candidates[i]))
        others = (*atoms[:first], *atoms[first + 1 :])
        for fact in list(candidates[first]):
            extended = unify(atoms[first], fact, binding)
            if extended is not None:
                yield from self.join(others, extended)

    def _candidates(self, atom: Atom, binding: Mapping[str, str]) -> Sequence[Fact]:
        best: Sequence[Fact] = self._by_predicate.get(atom.predicate, ())
        for position, term in enumerate(atom.terms, start=1):
            name = binding.get(term) if term.startswith("?") else term
            if name is not None:
                found = self._by_object.get((atom.predicate, position, name), ())
                if len(found) < len(best):
                    best = found
        return best


def unify(atom: Atom, fact: Fact, binding: dict[str, str]) -> dict[str, str] | None:
    """Return the binding extended so that the atom is the fact, or None."""
    if len(fact) != len(atom.terms) + 1 or fact[0] != atom.predicate:
        return None
    extended = dict(binding)
    for term, name in zip(atom.terms, fact[1:], strict=True):
        if term[0] != "?":
            if term != name:
                return None
        elif extended.setdefault(term, name) != name:
            return None
    return extended
