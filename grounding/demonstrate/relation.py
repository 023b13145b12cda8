"""The relation that is demonstrated: its name, and what its arguments are."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from grounding.relations.options import check_name
from tamp.errors import InputError

MOST_ARGUMENTS = 4
"""Arguments of a relation that the page has colours for."""

LONGEST = 40
"""Characters of a name."""

KINDS = (
    "object", "box", "can", "cup", "bowl", "bottle", "plate", "stick", "container", "surface",
)  # fmt: skip
"""What an argument may be: `object` is any body that a hand can move."""

PRESETS: Mapping[str, str] = {
    "upright(o)": "o stands the right way up",
    "lying(o, s: surface)": "o lies on the surface s",
    "stack(a, b)": "a stands on top of b",
    "left_of(a, b)": "a stands to the left of b",
    "next_to(a, b)": "a stands beside b",
    "facing(a, b)": "a is turned towards b",
    "within(a, b: container)": "a is in the container b",
    "set_cup(a: cup, b: plate)": "the cup a stands where it belongs beside the plate b",
    "between(a, b, c)": "a stands between b and c",
}
"""Relations to begin with, and what they mean."""

_NAME = re.compile(r"[a-z][a-z0-9_-]*", re.IGNORECASE)
_CALL = re.compile(r"\s*([^\s():,]+)\s*\(\s*(.*?)\s*\)\s*", re.DOTALL)
_FACT = re.compile(r"\s*\(\s*([^()]*?)\s*\)\s*", re.DOTALL)

GUESSED: Mapping[str, str] = {
    **{kind: kind for kind in KINDS},
    **dict.fromkeys(("s", "place", "table", "shelf", "board"), "surface"),
    **dict.fromkeys(("crate", "basket", "bin", "drawer", "carton"), "container"),
    **dict.fromkeys(("mug", "glass"), "cup"),
    **dict.fromkeys(("fork", "knife", "spoon", "pen"), "stick"),
    **dict.fromkeys(("saucer", "tray"), "plate"),
    **dict.fromkeys(("tin",), "can"),
}
"""The kind of an argument by its name, where none is said: `lying(o, shelf)`."""


@dataclass(frozen=True)
class Argument:
    """An argument of a relation: its name and its kind, one of KINDS."""

    name: str
    kind: str = "object"


@dataclass(frozen=True)
class DemonstratedRelation:
    """A relation to demonstrate; the first argument is the body that a plan would place."""

    name: str
    arguments: tuple[Argument, ...]

    def __str__(self) -> str:
        shown = (
            one.name if GUESSED.get(one.name, "object") == one.kind else f"{one.name}: {one.kind}"
            for one in self.arguments
        )
        return f"{self.name}({', '.join(shown)})"

    @property
    def meaning(self) -> str:
        """Return what it means, where it is one of PRESETS."""
        return next((said for text, said in PRESETS.items() if parse_relation(text) == self), "")


def parse_relation(text: str) -> DemonstratedRelation:
    """Parse a relation as users write it: `stack(a, b)`, `inside(a, b: container)`, `(stack a b)`.

    Raises:
        InputError: It is none, or a name or a kind is not allowed.
    """
    call, fact = _CALL.fullmatch(text), _FACT.fullmatch(text)
    if call:
        name, parts = call[1], [part.strip() for part in call[2].split(",")] if call[2] else []
    elif fact and fact[1]:
        name, *parts = fact[1].split()
    else:
        raise InputError(
            f"'{text}' is no relation with its arguments",
            remedy="Such as stack(a, b), upright(o), or inside(a, b: container)",
        )

    _check_name(name, "relation")
    arguments = tuple(_argument(part) for part in parts)
    _check_arguments(name, arguments)
    return DemonstratedRelation(name.lower(), arguments)


def _argument(text: str) -> Argument:
    name, _, kind = (part.strip() for part in text.partition(":"))
    name = name.removeprefix("?").lower()
    _check_name(name, "argument")
    kind = kind.lower() or GUESSED.get(name, "object")
    if kind not in KINDS:
        raise InputError(f"argument {name}: unknown kind '{kind}'", found=kind, choices=KINDS)
    return Argument(name, kind)


def _check_name(name: str, what: str) -> None:
    if not _NAME.fullmatch(name) or len(name) > LONGEST:
        raise InputError(
            f"'{name}' cannot be the name of a {what}"
            if what == "relation"
            else f"'{name}' cannot be the name of an {what}",
            remedy=f"A letter, then letters, digits, _ or -; at most {LONGEST} characters",
        )
    if what == "relation":
        check_name(name)


def _check_arguments(name: str, arguments: tuple[Argument, ...]) -> None:
    if not 1 <= len(arguments) <= MOST_ARGUMENTS:
        raise InputError(
            f"'{name}' has {len(arguments)} arguments",
            remedy=f"One to {MOST_ARGUMENTS}, such as {name}(a, b)",
        )
    names = [one.name for one in arguments]
    for one in names:
        if names.count(one) > 1:
            raise InputError(f"'{one}' is an argument of '{name}' twice")
    if arguments[0].kind == "surface":
        raise InputError(
            f"the first argument of '{name}' is a surface",
            remedy="Name first the body that a plan would place",
        )
    if sum(one.kind == "surface" for one in arguments) > 1:
        raise InputError(f"'{name}' has two surfaces", remedy="One is shown in a scene")
