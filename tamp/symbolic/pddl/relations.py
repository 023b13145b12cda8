"""The relations of a streams file: which certified facts say that one holds, and of what it is
asked.

By convention a relation R has the streams sample-R, which proposes, and test-R, which judges. What
test-R certifies says that R holds; where there is no such stream, it is what sample-R alone
certifies. The generator may serve further streams, for places of other kinds (`SAMPLE_SUFFIXES`).
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from itertools import product

from tamp.symbolic.pddl.atoms import signed_atoms
from tamp.symbolic.pddl.complement import complement_name
from tamp.symbolic.pddl.structs import Atom, Domain, Fact, Formula, Stream, StreamFile

SAMPLE_PREFIX = "sample-"
"""How the names of streams begin that propose; so named, they only take advice from the state."""

POSE = "pose"
"""The predicate and the type of a body's pose."""

BODY_KINDS = frozenset({"body", "movable", "fixed", "surface", "container"})
"""What the scene says that objects are, by types or by unary facts."""

POSE_POSITIONS = frozenset({(POSE, 1), ("at-pose", 1)})
"""Predicates and places of theirs that poses stand at in any domain."""

SAMPLE_SUFFIXES = ("", "-inside", "-on-movable", "-inside-movable")
"""Ends of the names of streams that one generator serves: sample-R, sample-R-inside, ..."""

TEST_SUFFIXES = ("", "-also")
"""The same of its classifier: test-R asks of what was proposed, test-R-also of any poses."""


@dataclass(frozen=True)
class Relation:
    """A relation as its streams declare it.

    Attributes:
        name: R.
        facts: What says that it holds, over variables: (stood ?o ?p ?s).
        arguments: The variables that stand for names, in the order in which a classifier is asked
            of them.
        poses: Each variable that stands for a pose, to the variable of the body that has it.
        stream: What certifies the facts.
    """

    name: str
    facts: tuple[Atom, ...]
    arguments: tuple[str, ...]
    poses: Mapping[str, str]
    stream: Stream

    @property
    def predicates(self) -> frozenset[str]:
        """Return the predicates of the facts."""
        return frozenset(atom.predicate for atom in self.facts)

    @property
    def bodies(self) -> tuple[str, ...]:
        """Return the arguments whose poses it depends on."""
        return tuple(variable for variable in self.arguments if variable in self.poses.values())

    def substitute(self, names: Mapping[str, str], at: Mapping[str, str]) -> tuple[Fact, ...]:
        """Substitute names for arguments' variables, and poses by the bodies' names, in the
        facts.
        """
        terms = {**names, **{pose: at[names[body]] for pose, body in self.poses.items()}}
        return tuple(
            (atom.predicate, *(terms.get(term, term) for term in atom.terms)) for atom in self.facts
        )


def relation_names(streams: StreamFile) -> tuple[str, ...]:
    """Return every R of which there is a stream sample-R or test-R."""
    split = [stream.name.partition("-") for stream in streams.streams]
    named = {(verb, name) for verb, _, name in split if verb in ("sample", "test") and name}
    further = {
        (verb, f"{name}{suffix}")
        for verb, suffixes in (("sample", SAMPLE_SUFFIXES), ("test", TEST_SUFFIXES))
        for _, name in named
        for suffix in suffixes[1:]
    }
    return tuple(dict.fromkeys(name for verb, _, name in split if (verb, name) in named - further))


def streams_of(name: str) -> tuple[str, ...]:
    """Return the names that streams of a relation may have."""
    sampled = (f"sample-{name}{suffix}" for suffix in SAMPLE_SUFFIXES)
    return (*sampled, *(f"test-{name}{suffix}" for suffix in TEST_SUFFIXES))


def relation_of(streams: StreamFile, domain: Domain, name: str) -> Relation | None:
    """Return the relation of a name; None where no fact says by its terms alone, poses and
    names, that it holds.
    """
    by_name = {stream.name: stream for stream in streams.streams}
    test, sample = by_name.get(f"test-{name}"), by_name.get(f"sample-{name}")
    stream = test or sample
    if stream is None or (test is not None and test.outputs):
        return None
    others = {
        atom.predicate for one in streams.streams if one is not stream for atom in one.certified
    }
    facts = stream.certified
    if test is None:
        facts = tuple(atom for atom in facts if atom.predicate not in others | {POSE})
    terms = {term for atom in facts for term in atom.terms}
    exact = all(terms == {*atom.terms} and len(terms) == len(atom.terms) for atom in facts)
    if not facts or not exact or (test is not None and terms != {*test.inputs}):
        return None

    arguments, poses = _roles(stream, _pose_variables(stream, sample, domain))
    poses = {pose: body for pose, body in poses.items() if pose in terms}
    arguments = tuple(variable for variable in arguments if variable in terms)
    complete = {*arguments, *poses} == terms and {*poses.values()} <= {*arguments}
    alone = len({*poses.values()}) == len(poses)  # a body in two places is in none
    return Relation(name, facts, arguments, poses, stream) if complete and alone else None


def instances(
    relation: Relation,
    domain: Domain,
    objects: Mapping[str, tuple[str, ...]],
    facts: Collection[Fact],
    placed: Collection[str],
    named: Collection[str],
) -> Iterator[dict[str, str]]:
    """Generate what a relation may be asked of: its arguments' variables to names, a body never
    together with itself.

    Args:
        relation: The relation.
        domain: Its domain.
        objects: Types by name.
        facts: What is known of objects: (movable mug), where the domain has predicates in the place
            of types.
        placed: Bodies that have a pose.
        named: Bodies and places of the scene.
    """
    choices: list[list[str]] = []
    for variable in relation.arguments:
        types, kinds = _wanted(relation.stream, relation.facts, domain, variable)
        choices.append(
            [
                name
                for name in objects
                if name in named
                and (name in placed or variable not in relation.bodies)
                and all(domain.fits(objects[name], wanted) for wanted in types)
                and all((kind, name) in facts for kind in kinds)
            ]
        )
    for names in product(*choices):
        if len({*names}) == len(names):
            yield dict(zip(relation.arguments, names, strict=True))


def needed_false(domain: Domain, goal: Formula, predicates: Collection[str]) -> Atom | None:
    """Find an atom of a condition that is helped by one of the predicates being false; None where
    there is none.

    It is the condition's own: (upright tea table) where rules lead from `upright` to the predicate.
    Whether an effect happens has to be known both ways.
    """
    roots = [*signed_atoms(goal)]
    for action in domain.actions:
        roots += signed_atoms(action.precondition)
        for effect in action.effects:
            roots += [
                (atom, sign)
                for atom, one in signed_atoms(effect.condition)
                for sign in (one, not one)
            ]
    return next((atom for atom, sign in roots if _leads(atom, sign, domain, predicates)), None)


def _leads(atom: Atom, sign: bool, domain: Domain, predicates: Collection[str]) -> bool:
    """Check that an atom that helps by holding, or by not holding, rests on one of the
    predicates being false.
    """
    stack, seen = [(atom.predicate, sign)], set[tuple[str, bool]]()
    while stack:
        predicate, helps = stack.pop()
        if predicate in predicates and not helps:
            return True
        if (predicate, helps) not in seen:
            seen.add((predicate, helps))
            bodies = (rule.body for rule in domain.derived if rule.head.predicate == predicate)
            stack += [
                (one.predicate, way) for body in bodies for one, way in signed_atoms(body, helps)
            ]
    return False


def failing(relation: Relation, domain: Domain) -> Stream:
    """Declare a stream that certifies that a relation does not hold, for poses of any origin."""
    conditions = [Atom(POSE, (body, pose)) for pose, body in relation.poses.items()]
    for variable in relation.arguments:
        types, kinds = _wanted(relation.stream, relation.facts, domain, variable)
        conditions += [
            Atom(one, (variable,)) for one in (*(one[0] for one in types if len(one) == 1), *kinds)
        ]
    certified = tuple(
        Atom(complement_name(atom.predicate, domain), atom.terms) for atom in relation.facts
    )
    inputs = tuple(_in_order(relation))
    return Stream(
        f"test-not-{relation.name}",
        inputs,
        tuple(conditions),
        (),
        certified,
        (),
        relation.stream.place,
    )


def _in_order(relation: Relation) -> Iterator[str]:
    """Generate the variables, a pose after its body."""
    for variable in relation.arguments:
        yield variable
        yield from (pose for pose, body in relation.poses.items() if body == variable)


def _roles(stream: Stream, poses: Collection[str]) -> tuple[tuple[str, ...], dict[str, str]]:
    """Tell the variables that stand for names, in order, from those for poses: each is that of
    the body before it.
    """
    names: list[str] = []
    bodies: dict[str, str] = {}
    for variable in stream.inputs:
        if variable in poses and names:
            bodies[variable] = names[-1]
        else:
            names.append(variable)
    bodies |= {output: names[0] for output in stream.outputs if output in poses and names}
    return tuple(names), bodies


def _pose_variables(stream: Stream, sample: Stream | None, domain: Domain) -> set[str]:
    """Find the variables of a stream that stand for poses, by what the domain declares or by
    what is sampled.
    """
    positions = {*POSE_POSITIONS}
    for one in domain.predicates.values():
        positions |= {
            (one.name, at) for at, declared in enumerate(one.parameters) if POSE in declared.types
        }
    if sample is not None:
        atoms = [
            (atom.predicate, at, term)
            for atom in sample.certified
            for at, term in enumerate(atom.terms)
        ]
        positions |= {
            (one, at)
            for one, at, term in atoms
            if term in sample.outputs and _may_be_pose(domain, one, at)
        }
    atoms = [(atom.predicate, at, term) for atom in (*stream.domain, *stream.certified)
             for at, term in enumerate(atom.terms)]  # fmt: skip
    return {term for predicate, at, term in atoms if (predicate, at) in positions}


def _may_be_pose(domain: Domain, predicate: str, at: int) -> bool:
    declared = domain.predicates.get(predicate)
    return declared is not None and any(
        one in ("object", POSE) for one in declared.parameters[at].types
    )


def _wanted(
    stream: Stream, facts: Collection[Atom], domain: Domain, variable: str
) -> tuple[list[tuple[str, ...]], list[str]]:
    """Return what an argument has to be: types, of each tuple one; and kinds that the domain has
    as predicates.
    """
    types: dict[tuple[str, ...], None] = {}
    kinds: dict[str, None] = {}
    for atom in (*stream.domain, *facts):
        declared = domain.predicates.get(atom.predicate)
        if declared is None:  # a type in the place of a predicate
            types |= dict.fromkeys([(atom.predicate,)] if variable in atom.terms else [])
        elif len(atom.terms) == 1 and atom.predicate in BODY_KINDS and atom.terms[0] == variable:
            kinds[atom.predicate] = None
        else:
            pairs = zip(atom.terms, declared.parameters, strict=True)
            types |= {
                one.types: None
                for term, one in pairs
                if term == variable and "object" not in one.types
            }
    return list(types), list(kinds)
