"""Completion of streams of own relations: their poses rest on the surface that they name."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from tamp.planner.movable_places import carries
from tamp.symbolic.pddl.relations import SAMPLE_SUFFIXES
from tamp.symbolic.pddl.structs import Atom, Domain, Stream, StreamFile

SUPPORTED = "supported"
"""(supported ?o ?p ?s): what `on` follows from in domains with scenes."""

RESTING_PREDICATES = {SUPPORTED, "contained", "borne"}
"""Facts by which a stream says itself on what its poses rest."""


def saying_where_poses_rest(
    declared: StreamFile, domain: Domain, relations: Collection[str], given: Collection[str] = ()
) -> StreamFile:
    """Certify `supported` of streams sample-R that name one surface and do not say so themselves.

    `sample_relation` puts each of their poses onto that surface. Without the fact `(on ?o ?s)`
    would be taken not to hold of a body that stands there.

    Args:
        declared: The streams of the domain.
        domain: Says whether there is `supported`.
        relations: Of the user's own, that a generator serves.
        given: Streams with functions of the user's own, of which nothing is known.
    """
    if SUPPORTED not in domain.predicates or carries(domain):
        return declared
    names = {f"sample-{name}{suffix}" for name in relations for suffix in SAMPLE_SUFFIXES} - {
        *given
    }
    return replace(
        declared,
        streams=tuple(
            _saying(stream) if stream.name in names else stream for stream in declared.streams
        ),
    )


def _saying(stream: Stream) -> Stream:
    places = [
        atom.terms[0]
        for atom in stream.domain
        if atom.predicate in ("surface", "container") and atom.terms[0] in stream.inputs
    ]
    surfaces = [one.terms[0] for one in stream.domain if one.predicate == "surface"]
    poses = [
        atom
        for atom in stream.certified
        if atom.predicate == "pose" and atom.terms[1:] == stream.outputs
    ]
    said = RESTING_PREDICATES.intersection(atom.predicate for atom in stream.certified)
    if said or len(places) != 1 or surfaces != places or len(poses) != 1:
        return stream
    fact = Atom(SUPPORTED, (*poses[0].terms, places[0]))
    return replace(stream, certified=(*stream.certified, fact))
