"""Results whose tables and pictures can be worked out by hand."""

from __future__ import annotations

from tests.benchmark.toys import TIMEOUT, line, some

PARTS = {"symbolic": 1.0, "motion": 3.0}


def results() -> list[dict]:
    """Default solves all four seeds in 1, 2, 3, 4 s; uniform two of them in 10 and 10 s, and one plan is refused."""
    default, uniform = some(4), some(4, ("uniform",))
    return [
        *(
            line(case, 1.0 + case.seed, parts_s=PARTS, cpu_s=0.5, commit="abc", load=1.0)
            for case in default
        ),
        *(line(case, 10.0, parts_s=PARTS, load=2.5) for case in uniform[:2]),
        line(uniform[2], 5.0, verified=False),
        line(uniform[3], 30.1, **TIMEOUT),
    ]
