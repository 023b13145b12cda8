"""tamp-learn ask, and tamp-learn explore of one's own relation: scenes that a person labels."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.random import Generator as Random

from grounding.relations.asking import questions
from grounding.relations.candidates import Candidate, candidates
from grounding.relations.demonstration_file import Demonstration, Label, demonstrations_of
from grounding.relations.demonstration_text import DemonstrationFile, write_demonstration
from grounding.relations.evidence import gather
from grounding.relations.files import weights_of
from grounding.relations.grounding import LearnedRelation
from grounding.relations.learner import Learned, learn
from grounding.relations.options import Ask
from grounding.relations.picture import write_picture
from grounding.relations.scenes import examples_of
from grounding.relations.situation import Situations, joined, situation_of
from grounding.relations.variety import missing, unvaried
from tamp.errors import InputError
from tamp.geometric.scene.classifier import LIKELY_PROBABILITY

YES, NO, SKIP, QUIT = ("y", "yes"), ("n", "no"), ("s", "skip", ""), ("q", "quit")


def ask(chosen: Ask) -> None:
    """Run tamp-learn ask.

    Raises:
        InputError: Bad demonstrations, no scene in which the relation would be proposed, or an
            answer that is none.
    """
    rng = np.random.default_rng(chosen.seed)
    state = _Learned.of(chosen.relation.lower(), chosen.demos, rng)
    for line in state.missing():
        print(f"missing: {line}")

    pool = candidates(state.relation, examples_of(state.shown), chosen.pool, rng)
    if not pool:
        raise InputError("no scene to ask about was found", remedy="Show more demonstrations")
    situations = joined([situation_of(one.scene, one.arguments) for one in pool])
    evidence = gather(state.rows(True), state.rows(False), rng)
    answered = 0
    for number, row in enumerate(
        questions(evidence, state.learned.committee, situations, chosen.count), 1
    ):
        one = pool[int(row)]
        path = _free(chosen.demos, state.name)
        picture = path.with_suffix(".png")
        if chosen.pictures:
            write_picture(picture, one.bodies, one.arguments, state.name)
        said = f"({state.name} {' '.join(one.arguments)})"
        where = f" ({picture})" if chosen.pictures else ""
        print(f"{number}. does {said} hold here?{where} [yes, no, skip, quit]", flush=True)
        answer = _answer()
        if answer in QUIT:
            picture.unlink(missing_ok=True)
            break
        if answer in SKIP:
            picture.unlink(missing_ok=True)
            continue
        _write(path, one, state.name, answer in YES, "answered")
        answered += 1
        print(f"  written: {path}")

    print(f"{answered} answered. Learn again: tamp-learn new {state.name} --demos {chosen.demos}")


def explore_own(name: str, demos: Path, out: Path | None, count: int, seed: int) -> None:
    """Write candidates that came to rest in physics as demonstration files, with what the
    classifier takes them for.

    Raises:
        InputError: Bad demonstrations, or the folder for the candidates has files.
    """
    folder = out or Path(f"{name}_explored")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError("it is there already", file=folder, remedy="Name a new folder with --out")
    rng = np.random.default_rng(seed)
    state = _Learned.of(name.lower(), demos, rng)
    found = candidates(state.relation, examples_of(state.shown), count, rng)
    for number, one in enumerate(found, 1):
        path, holds = (
            folder / f"{state.name}_{number:03d}.yaml",
            one.probability >= LIKELY_PROBABILITY,
        )
        note = f"{'Yes' if holds else 'No'}, says the classifier ({one.probability:.2f}). Right?"
        _write(path, one, state.name, holds, note)
        write_picture(path.with_suffix(".png"), one.bodies, one.arguments, state.name)
    stayed = [one.stayed for one in found if one.proposed]
    print(f"{folder}: {len(found)} scenes that came to rest, each with a picture")
    print(f"of {len(stayed)} proposals {sum(stayed)} stayed where they were put")
    print("Look them over: where the goal is wrong, put (not ...) around it, or take it away")
    print(f"then copy them to {demos}, and: tamp-learn new {state.name} --demos {demos}")


@dataclass(frozen=True, eq=False)
class _Learned:
    """Demonstrations, and what was learned from them."""

    name: str
    shown: list[Demonstration]
    learned: Learned
    relation: LearnedRelation
    situations: Situations

    @classmethod
    def of(cls, name: str, demos: Path, rng: Random) -> _Learned:
        if not demos.exists():
            raise InputError("no demonstrations there", file=demos, remedy="--demos FOLDER")
        shown = list(demonstrations_of(name, [demos]))
        learned = learn(name, shown, rng)
        situations = joined([situation_of(one.scene, one.arguments) for one in shown])
        return cls(name, shown, learned, LearnedRelation(weights_of(learned, {})), situations)

    def rows(self, holds: bool) -> Situations:
        """Return the situations of one label."""
        chosen = [row for row, one in enumerate(self.shown) if one.holds == holds]
        return self.situations.rows(chosen)

    def missing(self) -> list[str]:
        """Return what the demonstrations lack."""
        holds = np.array([one.holds for one in self.shown])
        names = self.shown[0].arguments
        lacking = [text for _, text in unvaried(self.situations, holds, names)]
        return [*missing(holds), *lacking]


def _answer() -> str:
    line = sys.stdin.readline()
    if not line:
        return QUIT[0]
    word = line.strip().lower()
    if word not in (*YES, *NO, *SKIP, *QUIT):
        raise InputError(
            f"'{word:.40}' is no answer", found=word, choices=("yes", "no", "skip", "quit")
        )
    return word


def _free(folder: Path, name: str) -> Path:
    """Return the first name of a file that is not there."""
    parent = folder if folder.is_dir() else folder.parent
    taken = {path.name for path in parent.iterdir()}
    number = next(n for n in range(1, 100_000) if f"{name}_asked_{n:03d}.yaml" not in taken)
    return parent / f"{name}_asked_{number:03d}.yaml"


def _write(path: Path, one: Candidate, name: str, holds: bool, note: str) -> None:
    label = Label(name, one.arguments, holds)
    write_demonstration(path, DemonstrationFile(one.bodies, [label], note))
