"""A Beta posterior of a stream's success, from earlier runs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Posterior:
    """Successes and failures of a stream's tries under a flat prior, Beta(1, 1), and their time.

    Attributes:
        successes: Tries that gave a value (for a test: that held).
        failures: The others.
        seconds: Wall-clock time inside its function.
    """

    successes: int = 0
    failures: int = 0
    seconds: float = 0.0

    @property
    def mean(self) -> float:
        """Return the expected probability that a try succeeds."""
        return (self.successes + 1) / (self.successes + self.failures + 2)

    @property
    def expected_failures(self) -> float:
        """Expected failures before a success: the posterior's mean of 1/p - 1."""
        return (self.failures + 1) / max(self.successes, 1)

    def __add__(self, other: Posterior) -> Posterior:
        """Add the tries of both."""
        return Posterior(
            self.successes + other.successes,
            self.failures + other.failures,
            self.seconds + other.seconds,
        )
