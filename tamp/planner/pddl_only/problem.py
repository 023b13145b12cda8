"""A purely symbolic problem: a PDDL domain and a PDDL problem file, no scene and no robot."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.lint import lint
from tamp.symbolic.pddl.parser import parse_domain, parse_task
from tamp.symbolic.pddl.structs import Task
from tamp.system.files import find_domain


@dataclass(frozen=True)
class SymbolicProblem:
    """A task and the files that it was read from.

    Attributes:
        task: Parsed.
        domain: The domain's file.
        problem: The problem's file.
        warnings: What looks odd, with places.
    """

    task: Task
    domain: Path
    problem: Path
    warnings: tuple[str, ...]

    @property
    def name(self) -> str:
        """Return the name in the problem's file."""
        return self.task.name


def load_symbolic(domain: str | Path, problem: str | Path) -> SymbolicProblem:
    """Read a domain and a problem for it, both in PDDL.

    Args:
        domain: A file, or the name of a shipped domain.
        problem: A file.

    Raises:
        InputError: With file, line and column of what is wrong.
    """
    domain_file, problem_file = find_domain(domain), Path(problem)
    parsed = parse_domain(read_pddl(domain_file), domain_file)
    task = parse_task(read_pddl(problem_file), parsed, problem_file)
    warnings = (*task.notes, *lint(parsed, None, task.goal, task.initial))
    return SymbolicProblem(task, domain_file.resolve(), problem_file.resolve(), warnings)
