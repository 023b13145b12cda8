"""Streams tied to their functions, and the real objects that they produce."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from numbers import Real
from typing import Any

from tamp.stream import Call, LateGenerator, Rejection, StreamKind, Wild
from tamp.symbolic.algorithms.experience.stream_statistics import StreamStatistics
from tamp.symbolic.pddl.structs import Atom, Fact, Stream
from tamp.system.deadline import Deadline, OutOfTime

StreamFunction = Callable[..., Any]
"""f(*input values, call: Call). A generator yields one value (or a tuple, one per output) or a
Rejection a try, and ends when nothing more is to come; a test returns a bool or a Rejection."""

MOST_WARNINGS = 100
"""Different warnings that are kept: nobody reads more, and each input may fail."""


@dataclass(frozen=True)
class BoundStream:
    """A declared stream, its function and output types; whether it `advises` only, so that what it
    certifies holds in any state; and its kind, which sorts the time that it takes.
    """

    declaration: Stream
    function: StreamFunction
    output_types: tuple[tuple[str, ...], ...]
    advises: bool = False
    kind: StreamKind = StreamKind.OTHER

    @property
    def name(self) -> str:
        """Return the declaration's name."""
        return self.declaration.name

    @property
    def is_test(self) -> bool:
        """Return whether it has no outputs."""
        return not self.declaration.outputs

    @property
    def is_fluent(self) -> bool:
        """Return whether what it certifies holds only in the state that it was shown."""
        return bool(self.declaration.fluents) and not self.advises

    @property
    def is_advisory(self) -> bool:
        """Return whether it may look at the state, yet certifies nothing about it."""
        return self.advises and bool(self.declaration.fluents)


@dataclass
class Objects:
    """The objects of a run: names for the symbolic half, values for the functions.

    Attributes:
        types: Name to types.
        values: Name to value; a body's value is its name.
        by_value: Whether equal values have one name; those without a hash go by identity.
    """

    types: dict[str, tuple[str, ...]]
    values: dict[str, Any]
    by_value: bool = False
    _names: dict[Any, str] = field(default_factory=dict[Any, str])
    _counts: dict[str, int] = field(default_factory=dict[str, int])

    def __post_init__(self) -> None:
        if self.by_value:
            self._names = {value_key(value): name for name, value in self.values.items()}

    def add(self, value: Any, types: tuple[str, ...], prefix: str) -> str:
        """Name a new value: p1, p2, ... in the order in which they come."""
        if self.by_value and value_key(value) in self._names:
            return self._names[value_key(value)]
        while True:
            count = self._counts.get(prefix, 0) + 1
            self._counts[prefix] = count
            name = f"{prefix}{count}"
            if name not in self.types:
                break
        self.types[name] = types
        self.values[name] = value
        if self.by_value:
            self._names[value_key(value)] = name
        return name


def value_key(value: Any) -> Any:
    """Return a key that equal values share: 1 and 1.0 are equal, others need the same type.

    Whatever has no hash is told apart by identity.
    """
    try:
        hash(value)
    except TypeError:
        return (id(value),)
    if isinstance(value, bool):
        return (bool, value)
    return (Real if isinstance(value, Real) else type(value), value)


@dataclass
class Instance:
    """A stream called with real inputs (and shown real fluents): its results, and how to draw more.

    Attributes:
        results: Names of the outputs, one tuple a success, in the order in which they were drawn.
        exhausted: Whether the function has ended.
        last: Why the last try failed, if it did.
        iterator: What the function returned, once it was called.
    """

    stream: BoundStream
    inputs: tuple[str, ...]
    fluents: frozenset[Fact]
    results: list[tuple[str, ...]] = field(default_factory=list[tuple[str, ...]])
    exhausted: bool = False
    last: Rejection | None = None
    iterator: Iterator[Any] | None = None


class Streams:
    """All stream instances of a run.

    Args:
        streams: By name.
        objects: The run's objects; results are added to it.
        make_rng: A random generator from a string that names the instance, so that what an instance
            draws does not depend on what was drawn elsewhere.
        deadline: The run's end, handed to the functions.
    """

    def __init__(
        self,
        streams: Mapping[str, BoundStream],
        objects: Objects,
        make_rng: Callable[[str], Any],
        deadline: Deadline,
    ) -> None:
        self.streams = streams
        self.objects = objects
        self.statistics = {name: StreamStatistics() for name in streams}
        self.warnings: list[str] = []
        self.wild: dict[Fact, None] = {}
        self.certain: set[Fact] = set()
        self.memory: dict[str, Any] = {}
        self.running: Instance | None = None
        self.ahead = False
        self._make_rng = make_rng
        self._deadline = deadline
        self._instances: dict[tuple[str, tuple[str, ...], frozenset[Fact]], Instance] = {}
        self._of_call: dict[tuple[str, tuple[str, ...]], list[Instance]] = {}

    def remember(self, earlier: Streams) -> None:
        """Go on with what another part of the same run has learned, and add to its warnings."""
        self.memory, self.warnings = earlier.memory, earlier.warnings

    def instance(
        self, name: str, inputs: tuple[str, ...], fluents: frozenset[Fact] = frozenset()
    ) -> Instance:
        """Return the instance of a stream for these inputs; the same one each time."""
        key = (name, inputs, fluents)
        instance = self._instances.get(key)
        if instance is None:
            instance = self._instances[key] = Instance(self.streams[name], inputs, fluents)
            self._of_call.setdefault((name, inputs), []).append(instance)
        return instance

    def instances(self, name: str, inputs: tuple[str, ...]) -> list[Instance]:
        """List all instances of a stream for these inputs, whatever fluents they were shown."""
        return self._of_call.get((name, inputs), [])

    def called(self) -> list[Instance]:
        """List all instances that were called so far, in the order in which they were first met."""
        return [made for made in self._instances.values() if made.results or made.last is not None]

    def false_tests(self) -> list[Instance]:
        """List the tests that were called and do not hold, in whatever state."""
        ended = (one for one in self._instances.values() if one.exhausted and not one.results)
        return [one for one in ended if one.stream.is_test and not one.stream.is_fluent]

    def draw(self, instance: Instance) -> tuple[str, ...] | None:
        """Try once more: return the outputs' names (none for a test), or None and set `last`."""
        if instance.exhausted:
            return None

        statistics = self.statistics[instance.stream.name]
        started = time.perf_counter()
        self.running = instance
        try:
            value = self._advance(instance)
            self.running = None
            more: Sequence[tuple[Any, ...]] = ()
            if isinstance(value, Wild):
                value, more = value.value, value.facts
            names = () if isinstance(value, Rejection) else self._name_outputs(instance, value)
            for predicate, *values in more:
                words = [self.objects.add(part, ("object",), "x") for part in values]
                self.wild[str(predicate).lower(), *words] = None
        except OutOfTime:
            raise
        except Exception as error:
            # a user's function may fail in any way; the plan does not hang on it
            instance.exhausted = True
            value, names = Rejection(f"raised {type(error).__name__}", given_up=True), ()
            _add_new(
                self.warnings,
                f"stream {instance.stream.name} raised {type(error).__name__}: {error}; "
                "that call is given up",
            )
        finally:
            statistics.seconds += time.perf_counter() - started

        statistics.calls += 1
        if isinstance(value, Rejection):
            instance.last = value
            statistics.reasons[value.reason] += 1
            return None
        statistics.successes += 1
        instance.results.append(names)
        if not instance.stream.is_fluent:
            self.certain.update(self.certified(instance, names))
        return names

    def warn(self, message: str) -> None:
        """Add to the warnings, unless it is there or there are many."""
        _add_new(self.warnings, message)

    def certified(self, instance: Instance, outputs: tuple[str, ...]) -> tuple[Fact, ...]:
        """Return the facts that a result makes true."""
        declaration = instance.stream.declaration
        variables = (*declaration.inputs, *declaration.outputs)
        return substitute(declaration.certified, variables, (*instance.inputs, *outputs))

    def _advance(self, instance: Instance) -> Any:
        values = self.objects.values
        if instance.iterator is None:
            facts = sorted(instance.fluents)
            shown = [tuple([values.get(word, word) for word in fact]) for fact in facts]
            # not methods: a call that knows the streams would keep them alive
            name, inputs, make_rng = instance.stream.name, instance.inputs, self._make_rng
            late = LateGenerator(lambda: make_rng(repr((name, inputs, facts))))
            warn = partial(_add_new, self.warnings)
            call = Call(late, self._deadline, shown, self.memory, self.ahead, warn)
            made = instance.stream.function(*(values[name] for name in instance.inputs), call=call)
            if instance.stream.is_test:
                instance.exhausted = True
                if isinstance(made, Rejection | Wild):
                    return made
                return () if made else Rejection("does not hold")
            instance.iterator = iter(made)

        for value in instance.iterator:
            return value
        instance.exhausted = True
        return instance.last or Rejection("has no value")

    def _name_outputs(self, instance: Instance, value: Any) -> tuple[str, ...]:
        declaration = instance.stream.declaration
        outputs = declaration.outputs
        if not outputs:
            return ()
        parts: Sequence[Any] = (value,) if len(outputs) == 1 else tuple(value)
        if len(parts) != len(outputs):
            raise ValueError(
                f"stream {instance.stream.name} yields {len(parts)} values "
                f"for {len(outputs)} outputs"
            )
        types = instance.stream.output_types
        return tuple(
            self.objects.add(part, types[i], outputs[i].lstrip("?").rstrip("0123456789") or "x")
            for i, part in enumerate(parts)
        )


FOREIGN_CALLERS = (Streams.draw.__code__,)
"""For an alarm: what calls the functions that anyone may have written."""


def substitute(
    atoms: Sequence[Atom], names: Sequence[str], objects: Sequence[str]
) -> tuple[Fact, ...]:
    """Return the facts of lifted atoms under a substitution of variables by objects."""
    table = dict(zip(names, objects, strict=True))
    return tuple(
        [(atom.predicate, *[table.get(term, term) for term in atom.terms]) for atom in atoms]
    )


def _add_new(warnings: list[str], message: str) -> None:
    if len(warnings) < MOST_WARNINGS and message not in warnings:
        warnings.append(message)
