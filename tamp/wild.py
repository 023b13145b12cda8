"""What a stream's function gives beside its outputs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Wild:
    """One try of a stream, and further facts that it found to be true.

    Attributes:
        value: What the function would have yielded without them: outputs, a test's answer, a Rejection.
        facts: Static facts with values in the place of objects: ("Near", conf_a, conf_b).
    """

    value: Any
    facts: Sequence[tuple[Any, ...]]
