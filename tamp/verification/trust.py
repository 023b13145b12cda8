"""Trust: what a verdict rests on unchecked, relations on trust and files not the problem's."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem
from tamp.plan.read import PlanFile
from tamp.plan.sources import sha256
from tamp.symbolic.pddl.atoms import signed_atoms
from tamp.symbolic.pddl.parser import parse_streams
from tamp.symbolic.pddl.relations import relation_names, relation_of
from tamp.symbolic.pddl.structs import Atom, Domain, Fact, Formula, StreamFile
from tamp.system.files import STREAMS_SUFFIX, find_domain, shipped
from tamp.verification.initial_state import KINDS_OF_OBJECTS


def streams_file(plan: PlanFile, override: Path | None, domain: Path | None = None) -> Path | None:
    """Find the streams' file: the user's, else the plan's, also of that name beside it.

    A plan that names none has those beside the domain.

    Raises:
        InputError: The user names none that there are.
    """
    if override is not None:
        if not override.is_file():
            raise InputError(f"no such file: {override}")
        return override
    source = plan.source("streams")
    if source is None:
        beside = [domain.with_suffix(STREAMS_SUFFIX)] if domain is not None else []
        return next((file for file in beside if file.is_file()), None)
    beside = [plan.file.parent / source.path.name] if plan.file else []
    return next((file for file in (source.path, *beside) if file.is_file()), None)


def read_streams(plan: PlanFile, file: Path | None, domain: Domain) -> StreamFile | None:
    """Read a plan's streams; None where there are none, or others by now that misfit its domain.

    Raises:
        InputError: The file is malformed, and it is that of the plan or the user names it.
    """
    if file is None:
        return None
    source = plan.source("streams")
    try:
        return parse_streams(file.read_text(encoding="utf-8"), domain, file)
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot be read: {error}", file=file) from None
    except InputError:
        if source is not None and source.sha256 != sha256(file):
            return None
        raise


def other_files(
    plan: PlanFile,
    loaded: LoadedProblem,
    domain: Path,
    streams: Path | None,
    given: Mapping[str, Path | None],
) -> tuple[str, ...]:
    """Name domain and streams judged by that are not the problem's, or no longer the plan's.

    Args:
        plan: The plan.
        loaded: The problem.
        domain: By which is judged.
        streams: By which is judged, if there are any.
        given: "domain" and "streams", where the user names them.
    """
    found: list[str] = []
    own = _own_domain(loaded)
    if loaded.domain is not None:
        named = Path(loaded.domain).name
        if own is None:
            found.append(f"by the domain {domain.name}; the problem's {named} is not there")
        elif sha256(own) != sha256(domain):
            found.append(f"by the domain {domain.name}, not the problem's {own.name}")

    beside = (own or domain).with_suffix(STREAMS_SUFFIX)
    source = plan.source("streams")
    if streams is None:
        if source is not None:
            found.append(f"without the streams {source.path.name}, which are not there")
    elif source is not None and source.sha256 != sha256(streams):
        found.append(
            f"by the streams {streams.name}, which are not those that the plan was made with"
        )
    elif beside.is_file() and sha256(beside) != sha256(streams):
        found.append(f"by the streams {streams.name}, not the problem's {beside.name}")
    elif (
        not beside.is_file()
        and given["streams"] is None
        and streams.with_suffix("").stem != domain.stem
    ):
        found.append(f"by the streams {streams.name}, as the plan says")

    return tuple(found)


def trusted_relations(
    plan: PlanFile,
    domain: Domain,
    goal: Formula,
    streams: StreamFile | None,
    decided: Collection[str],
    given: Collection[Fact],
) -> tuple[str, ...]:
    """List relations that goal and actions rest on, and about which only the plan says what holds.

    One that has to hold is meant where the plan states facts of it; one that must not hold also
    where it states none.

    Args:
        plan: The plan.
        domain: Its domain.
        goal: Its goal.
        streams: Its streams, where they are known.
        decided: Predicates that the judge decides by itself.
        given: The initial facts that the problem states.
    """
    names = _names(streams, domain)

    stated = {fact[0] for fact in plan.certified} | {
        fact[0] for fact in plan.initial if fact not in given
    }
    certified = (
        {atom.predicate for one in streams.streams for atom in one.certified} if streams else stated
    )

    decided_elsewhere = {
        *decided,
        *domain.fluent_predicates,
        *domain.derived_predicates,
        *KINDS_OF_OBJECTS,
        "=",
        *domain.types,
    }

    found = {
        names.get(predicate, predicate)
        for predicate, sign in _rested_on(plan, domain, goal)
        if predicate not in decided_elsewhere and predicate in (stated if sign else certified)
    }
    return tuple(sorted(found))


def certifiable(plan: PlanFile, domain: Domain, streams: StreamFile | None) -> frozenset[str]:
    """Return the static predicates that streams certify.

    All of them where the plan's streams are not there; where it names none, its own.
    """
    static = (
        domain.predicates.keys()
        - domain.fluent_predicates
        - domain.derived_predicates
        - KINDS_OF_OBJECTS
    )
    if streams is None:
        named = plan.source("streams") is not None
        return frozenset(static if named else static & {fact[0] for fact in plan.certified})
    return (
        frozenset(
            atom.predicate for one in (*streams.streams, *streams.rules) for atom in one.certified
        )
        & static
    )


def domain_note(loaded: LoadedProblem, domain: Path, given: bool) -> tuple[str, ...]:
    """Note that only the plan says by which domain a problem is meant, unless that one ships."""
    if (
        loaded.domain is not None
        or given
        or domain.parent.resolve() == shipped("domains").resolve()
    ):
        return ()
    return (f"the problem names no domain; judged by {domain.name}, as the plan says",)


def _own_domain(loaded: LoadedProblem) -> Path | None:
    if loaded.domain is None:
        return None
    try:
        return find_domain(loaded.domain, loaded.path.parent)
    except InputError:
        return None


def _names(streams: StreamFile | None, domain: Domain) -> dict[str, str]:
    """Map certified predicates to the relation that each speaks of."""
    found: dict[str, str] = {}
    for name in relation_names(streams) if streams else ():
        relation = relation_of(streams, domain, name) if streams else None
        if relation is not None:
            found |= dict.fromkeys(relation.predicates, name)
    return found


def _rested_on(plan: PlanFile, domain: Domain, goal: Formula) -> Iterator[tuple[str, bool]]:
    """Yield predicates that goal and actions ask for, through rules, each with whether it helps."""
    used = {action.name for action in plan.actions}
    stack: list[tuple[Atom, bool]] = [*signed_atoms(goal)]

    for action in (one for one in domain.actions if one.name in used):
        stack += signed_atoms(action.precondition)
        for effect in action.effects:
            stack += [
                (atom, sign)
                for atom, one in signed_atoms(effect.condition)
                for sign in (one, not one)
            ]

    seen: set[tuple[str, bool]] = set()
    while stack:
        atom, sign = stack.pop()
        if (atom.predicate, sign) in seen:
            continue
        seen.add((atom.predicate, sign))
        yield atom.predicate, sign
        for rule in domain.derived:
            if rule.head.predicate == atom.predicate:
                stack += signed_atoms(rule.body, sign)
