"""A learned relation in a domain's files: its words put into the text as it stands."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path

from grounding.relations.pddl_words import CARRIES, Words, domain_parts, settled_parts, stream_parts
from tamp.errors import InputError
from tamp.symbolic.pddl.files import read_pddl
from tamp.symbolic.pddl.parser import parse_domain, parse_streams
from tamp.system.files import shipped

BASE, CARRIERS = "cupboard", "carriers"
"""The shipped domains that a new file begins as; the second where bodies stand on movable ones."""


def added(domain: Path, words: Words, note: str) -> dict[Path, tuple[str, str]]:
    """Return the domain's two files with a relation in them: path to old and new text.

    A domain that is not there begins as a shipped one.

    Raises:
        InputError: A file cannot be read or understood, or has another thing of this name; or the
            relation puts bodies onto movable ones, which the domain does not know.
    """
    streams = domain.with_suffix(".streams.pddl")
    shipped_one = CARRIERS if words.below else BASE
    texts: dict[Path, tuple[str, str]] = {}
    for path, suffix in ((domain, ".pddl"), (streams, ".streams.pddl")):
        if path.exists():
            old = read_pddl(path)
            if "\ufffd" in old:
                what = "a comment in it is not UTF-8 and would be lost"
                raise InputError(what, file=path, remedy="Save it as UTF-8")
            texts[path] = (old, old)
        else:
            base = read_pddl(shipped("domains") / f"{shipped_one}{suffix}")
            texts[path] = ("", _renamed(base, shipped_one, domain.stem))

    parsed = parse_domain(texts[domain][1], domain)
    declared = parse_streams(texts[streams][1], parsed, streams)
    present = parsed.predicates.get(words.name)
    names = {stream.name for stream in declared.streams}
    if present is not None and len(present.parameters) != len(words.kinds):
        what = (
            f"'{words.name}' has {len(present.parameters)} arguments here, not {len(words.kinds)}"
        )
        raise InputError(what, file=domain, remedy="Choose another name, or another domain")

    carries = {*CARRIES} <= {*parsed.predicates}
    if words.below and not carries:
        what = f"'{words.name}' puts bodies onto movable ones, and this domain cannot say so"
        remedy = f"Begin with a new file, which is as the shipped domain '{CARRIERS}'"
        raise InputError(what, file=domain, remedy=remedy)

    told, settling = (
        ([], [])
        if "settled" in parsed.predicates
        else settled_parts([one for one in ("supported", "contained") if one in parsed.predicates])
    )
    old, text = texts[domain]
    if present is None:
        predicates, rule = domain_parts(words)
        predicates = [*told, *predicates]
        text = _inside(text, "(:predicates", [f"; {note}", *predicates], domain)
        text = _before(text, "(:action", rule, domain)
    elif not any(one.head.predicate == words.name for one in parsed.derived):
        what = f"'{words.name}' is there already, and no rule says when it holds"
        raise InputError(what, file=domain, remedy="Choose another name, or another domain")
    texts[domain] = (old, text)

    old, text = texts[streams]
    if f"sample-{words.name}" not in names and f"test-{words.name}" not in names:
        text = _at_end(text, [*settling, f"; {note}", *stream_parts(words, carries)], streams)
    texts[streams] = (old, text)

    checked = parse_domain(texts[domain][1], domain)
    parse_streams(texts[streams][1], checked, streams)
    return texts


def diff(texts: dict[Path, tuple[str, str]]) -> str:
    """Return what changes, as a unified diff."""
    lines: list[str] = []
    for path, (old, new) in texts.items():
        lines += difflib.unified_diff(
            old.splitlines(), new.splitlines(), str(path) if old else "/dev/null", str(path),
            lineterm="", n=1,
        )  # fmt: skip
    return "\n".join(lines)


def _renamed(text: str, base: str, name: str) -> str:
    word = "".join(one if one.isalnum() or one in "-_" else "-" for one in name)
    word = word if word[:1].isalpha() else f"domain-{word}"
    for kind in ("domain", "stream"):
        text = text.replace(f"({kind} {base})", f"({kind} {word})")
    return text.replace(f"values of {base}.pddl", f"values of {name}.pddl")


def _inside(text: str, start: str, lines: Sequence[str], file: Path) -> str:
    """Put lines at the end of the list that begins with a word."""
    begin = _find(text, start)
    if begin is None:
        raise InputError(f"there is no '{start} ...)' to add to", file=file)
    return _put(text, _closing(text, begin, file), lines, "    ")


def _before(text: str, start: str, lines: Sequence[str], file: Path) -> str:
    """Put lines before the first list that begins with a word, or at the end."""
    begin = _find(text, start)
    if begin is None:
        return _at_end(text, lines, file)
    line = text.rfind("\n", 0, begin) + 1
    before = text[:line].rstrip("\n")
    return before + "\n" + "".join(f"  {one}\n" for one in lines) + "\n" + text[line:]


def _at_end(text: str, lines: Sequence[str], file: Path) -> str:
    """Put lines at the end of the file's only list."""
    begin = _find(text, "(")
    if begin is None:
        raise InputError("there is no '(define ...)' to add to", file=file)
    return _put(text, _closing(text, begin, file), lines, "  ")


def _put(text: str, end: int, lines: Sequence[str], indent: str) -> str:
    """Put lines before a closing parenthesis; one that a comment's line ends keeps its own line."""
    before = text[:end].rstrip()
    return before + "\n" + "\n".join(indent + one for one in lines) + text[end:]


def _find(text: str, start: str) -> int | None:
    """Find where a list begins, outside of comments; case does not count."""
    for at in _parentheses(text):
        if text[at] == "(" and text[at : at + len(start)].lower() == start:
            return at
    return None


def _closing(text: str, begin: int, file: Path) -> int:
    depth = 0
    for at in _parentheses(text):
        if at >= begin:
            depth += 1 if text[at] == "(" else -1
            if depth == 0:
                return at
    raise InputError("a parenthesis is not closed", file=file)


def _parentheses(text: str) -> list[int]:
    """List where parentheses stand that are in no comment."""
    found: list[int] = []
    comment = False
    for at, one in enumerate(text):
        if one == "\n":
            comment = False
        elif one == ";":
            comment = True
        elif one in "()" and not comment:
            found.append(at)
    return found
