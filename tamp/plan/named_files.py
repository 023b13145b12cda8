"""Files that a problem names beside those of its scene: they are the user's, whoever reads them."""

from __future__ import annotations

import contextlib
from pathlib import Path

from tamp.errors import InputError
from tamp.geometric.loading.load import LoadedProblem
from tamp.geometric.samplers.choice import sampler_files
from tamp.system.files import find_domain


def named_files(loaded: LoadedProblem) -> tuple[Path, ...]:
    """List the domain, its streams and the files of samplers, as far as the problem names them."""
    folder = loaded.path.parent
    named = [folder / file for file in sampler_files(loaded.samplers.values())]
    if loaded.domain is not None:
        with contextlib.suppress(InputError):
            domain = find_domain(loaded.domain, folder)
            named += [domain, domain.with_suffix(".streams.pddl")]
    return tuple(named)
