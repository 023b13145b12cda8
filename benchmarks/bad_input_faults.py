"""Faults that files and words can have, each drawn from a generator of random numbers."""

from __future__ import annotations

import io
import json
import os
import random
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

RAW = {
    "@nan": "NaN", "@inf": "1e999", "@huge": "1e300", "@digits": "9" * 5000, "@minus": "-" + "9" * 5000,
    "@deep": "[" * 20_000, "@nested": "[" * 400 + "]" * 400,
}  # fmt: skip
"""What JSON's writer would not write, by the word that stands for it until it has."""

EVIL = "a\x1b[31mRED\x1b]0;title\x07\u202eb\nSolved in 0 s"

LEAVES: tuple[Any, ...] = (
    None, True, False, 0, -1, 1, 0.5, -1e9, 10**15, 2**63, "", "x", EVIL, "x" * 200_000, "../../etc/passwd", "\ud800",
    "</script><script>", "@DATA@", "a\0b", "/dev/zero", [], {}, [[]], [None], {"a": 1}, [1, 2, 3], [1e5] * 2000, *RAW,
)  # fmt: skip

NUMBERS = (
    "nan", "inf", "-inf", "1e300", "-1e300", "1e999", "0", "-1", "1e-300", "", "x", "9" * 5000, "1e", "0x10", "1_0",
    "١", "--1", "1 2", "1e15", "-0.0001", "3.5.1", "1,5", "1e6",
)  # fmt: skip

WORDS = (
    "", " ", "x", "nan", "inf", "-inf", "-1", "0", "1e300", "1e-300", "9" * 400, "1.5", "x" * 300, "x" * 5000, "/",
    ".", "/dev/zero", "/dev/full", "/proc/self/mem", "/nowhere/x", "p.yaml", "plan.json", "cupboard.pddl", "d.npz",
    "b.jsonl", "thing.obj", "pipe", "loop", "folder", "on=", "=x", "on=on", "on=p.yaml", "on=plan.json",
    "on=none.safetensors", "on=none.py", "a\x1b[31mb", "\u202eabc", "ü", "\U0001f916", "0x0", "99999x99999", "64x",
    "-5x-5", "[]", "{}", "None", "true", "a=b=c", "--", "-x", "local:1", "1e9x1",
)  # fmt: skip


def spoil_json(text: str, draw: random.Random, others: list[bytes]) -> bytes:
    """A document with one to three of its values missing or something else."""
    if draw.random() < 0.15:
        return spoil_bytes(text.encode(), draw, others)
    document = json.loads(text)
    for _ in range(draw.choice((1, 1, 1, 2, 3))):
        document = _spoilt(document, draw)
    written = json.dumps(document)
    for word, raw in RAW.items():
        written = written.replace(json.dumps(word), raw)
    return written.encode()


def spoil_lines(text: str, draw: random.Random, others: list[bytes]) -> bytes:
    """JSON lines, one of them spoilt."""
    lines = text.splitlines()
    at = draw.randrange(len(lines))
    spoilt = spoil_json(lines[at], draw, others)
    return b"\n".join([*(line.encode() for line in lines[:at]), spoilt, *(line.encode() for line in lines[at + 1 :])])


def spoil_text(text: str, draw: random.Random, others: list[bytes]) -> bytes:
    """A text with a word, a line or a number that is missing, elsewhere or something else."""
    fault = draw.choice(TEXT_FAULTS)
    return fault(text, draw) if draw.random() < 0.8 else spoil_bytes(text.encode(), draw, others)


def spoil_yaml(text: str, draw: random.Random, others: list[bytes]) -> bytes:
    """A text like others, or one with what only YAML has."""
    if draw.random() < 0.7:
        return spoil_text(text, draw, others)
    return draw.choice(YAML_FAULTS)(text, draw).encode("utf-8", "surrogatepass")


def spoil_bytes(content: bytes, draw: random.Random, others: list[bytes]) -> bytes:
    """Bytes that are cut, changed, doubled, or those of another file."""
    at = draw.randrange(len(content) + 1)
    few = bytes(draw.randrange(256) for _ in range(draw.choice((1, 4, 64))))
    return draw.choice((
        lambda: content[:at], lambda: content[at:], lambda: b"", lambda: content[:at] + few + content[at + len(few) :],
        lambda: content[:at] + few + content[at:], lambda: content + content, lambda: draw.choice(others),
        lambda: few * 1000, lambda: bytes(len(content)),
        lambda: b"\xff\xfe" + content.decode("latin-1").encode("utf-16-le"),
        lambda: b"\xff" * 8 + content[8:], lambda: content[:at] + b"\0" + content[at:], lambda: b"PK\x03\x04" + content,
        lambda: content.replace(b"\n", b"\r\n"), lambda: content[:80] + b"\xff\xff\xff\x7f" + content[84:],
    ))()  # fmt: skip


def spoil_arrays(content: bytes, draw: random.Random, others: list[bytes]) -> bytes:
    """An .npz archive with an array that is missing, of another type, shape or value."""
    if draw.random() < 0.25:
        return spoil_bytes(content, draw, others)
    with np.load(io.BytesIO(content)) as archive:
        arrays: dict[str, Any] = {name: archive[name] for name in archive.files}
    name = draw.choice(sorted(arrays))
    found = arrays[name]
    changed: list[Callable[[], Any]] = [
        lambda: None, lambda: found[:-1], lambda: found.astype(str), lambda: found.astype(bool),
        lambda: found[..., None],
        lambda: found.ravel(), lambda: found * 0, lambda: found.astype(float) * np.nan,
        lambda: found.astype(float) * 1e300,
        lambda: found + (1 if found.dtype != bool else True), lambda: np.zeros((0, *found.shape[1:]), found.dtype),
        lambda: np.array(found, dtype=object), lambda: -np.abs(found.astype(float)), lambda: np.zeros(()),
        lambda: found.astype(complex), lambda: np.concatenate([found, found]), lambda: np.full(found.shape, 10**6),
    ]  # fmt: skip
    array = draw.choice(changed)()
    arrays = {key: value for key, value in arrays.items() if key != name}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for key, value in arrays.items() if array is None else [*arrays.items(), (name, array)]:
            part = io.BytesIO()
            np.lib.format.write_array(part, np.asanyarray(value), allow_pickle=True)
            entry = part.getvalue()
            if key == name and draw.random() < 0.1:  # claims gigabytes
                entry = re.sub(rb"'shape': \([^)]*\)", lambda m: b"'shape': (9999999999,)".ljust(len(m[0])), entry)
            archive.writestr(f"{key}.npy", entry)
    return buffer.getvalue()


def spoil_place(path: Path, draw: random.Random) -> None:
    """Something else than a file, or none, in a file's place."""
    kind = draw.choice(("gone", "folder", "pipe", "zero", "loop", "dangling", "large"))
    path.unlink()
    if kind == "folder":
        path.mkdir()
    elif kind == "pipe":
        os.mkfifo(path)
    elif kind == "large":
        with path.open("wb") as stream:
            stream.truncate(20 * 10**9)
    elif kind != "gone":
        path.symlink_to({"zero": "/dev/zero", "loop": path.name, "dangling": "nowhere"}[kind])


def _spoilt(document: Any, draw: random.Random) -> Any:
    """The document with one value, somewhere, gone or something else."""
    if draw.random() < 0.02 or not isinstance(document, dict | list) or not document:
        return draw.choice(LEAVES)
    place, path = document, draw.choice((0.5, 0.7, 0.9))
    while True:
        key = draw.choice(list(place) if isinstance(place, dict) else range(len(place)))
        inner = place[key]
        if not isinstance(inner, dict | list) or not inner or draw.random() > path:
            break
        place = inner
    fault = draw.randrange(8)
    if fault == 0:
        del place[key]
    elif fault == 1 and isinstance(place, dict):
        place[draw.choice(("", EVIL, "x", "a b", "y" * 5000))] = place.pop(key)
    elif fault == 2:
        place[key] = [inner] * 3
    elif fault == 3 and isinstance(inner, list):
        draw.shuffle(inner)
    elif fault == 4 and isinstance(inner, int | float) and not isinstance(inner, bool):
        place[key] = draw.choice((-inner, inner + 1, inner * 1e6, str(inner), inner - 1e-3, "@nan", "@huge"))
    elif fault == 5 and isinstance(inner, str):
        place[key] = draw.choice((inner.upper(), inner + " ", inner[::-1], inner * 2, "no_such_name", EVIL))
    else:
        place[key] = draw.choice(LEAVES)
    return document


def _lines(text: str, draw: random.Random) -> bytes:
    lines = text.splitlines()
    at, other = draw.randrange(len(lines)), draw.randrange(len(lines))
    fault = draw.randrange(4)
    if fault == 0:
        del lines[at]
    elif fault == 1:
        lines.insert(at, lines[other])
    elif fault == 2:
        lines[at], lines[other] = lines[other], lines[at]
    else:
        lines[at] = draw.choice(
            ("\t" + lines[at], lines[at] * 3, lines[at][::-1], EVIL, "#" + lines[at], "x" * 100_000)
        )
    return ("\n".join(lines) + "\n").encode()


def _words(text: str, draw: random.Random) -> bytes:
    words = list(re.finditer(r"[\w.:?/-]+", text))
    one, other = draw.choice(words), draw.choice(words)
    new = draw.choice(
        (other[0], "", "no_such_name", one[0] * 2, "x" * 5000, EVIL, "nil", "?x", "object", "/dev/zero", "~")
    )
    return (text[: one.start()] + new + text[one.end() :]).encode()


def _numbers(text: str, draw: random.Random) -> bytes:
    found = list(re.finditer(r"-?\d+\.?\d*", text))
    if not found:
        return _words(text, draw)
    one = draw.choice(found)
    return (text[: one.start()] + draw.choice(NUMBERS) + text[one.end() :]).encode()


def _signs(text: str, draw: random.Random) -> bytes:
    at = draw.randrange(len(text))
    new = draw.choice(
        ("(", ")", "[", "]", "{", "}", "<", ">", '"', "'", ":", "&", "*", "\\", "\0", "\x1b", ";", "%", "\u202e")
    )
    return (text[:at] + new + text[at + draw.randrange(2) :]).encode()


def _deep(text: str, draw: random.Random) -> bytes:
    at = draw.randrange(len(text))
    opening, closing = draw.choice(
        (("(", ")"), ("[", "]"), ("{", "}"), ("(and ", ")"), ("<a>", "</a>"), ("(not ", ")"))
    )
    count = draw.choice((200, 5_000, 100_000))
    return (text[:at] + opening * count + closing * draw.choice((0, count)) + text[at:]).encode()


def _lisp(text: str, draw: random.Random) -> bytes:
    """What only PDDL has; a word elsewhere in other texts."""
    if "(:types" not in text and "(:objects" not in text:
        return _words(text, draw)
    count = draw.choice((200, 10_000))
    chain = " ".join(f"t{n} - t{n + 1}" for n in range(count))
    many = " ".join(f"o{n}" for n in range(count))
    variables = " ".join(f"?v{n}" for n in range(count))
    changes = (
        ("(:types", f"(:types {chain} "), ("(:types", f"(:types t{count} - t0 {chain} "),
        ("(:types", f"(:types {many} - "),
        ("(:objects", f"(:objects {many} - "), ("(:predicates", f"(:predicates (wide {variables}) "),
        (":parameters (", f":parameters ({variables} "), ("(and ", "(and " + "(and) " * count),
        ("(and ", "(or (not (and"),
        ("(:requirements", "(:requirements :durative-actions :preferences"),
        (":precondition (and", ":precondition (forall (?z"),
        ("(:goal", "(:goal (forall (?z) (exists (?w) (on ?z ?w)))) (:goal"), ("(define", "(define (define"),
    )  # fmt: skip
    usable = [change for change in changes if change[0] in text]
    old, new = draw.choice(usable)
    return text.replace(old, new, 1).encode()


TEXT_FAULTS = (_lisp, _lines, _words, _words, _numbers, _numbers, _signs, _signs, _deep)


def _merges(text: str, draw: random.Random) -> str:
    levels = draw.choice((3, 30, 200))
    chain = "".join(f"  m{n}: &m{n} {{<<: [{', '.join([f'*m{n - 1}'] * 9) if n else ''}]}}\n" for n in range(levels))
    return text.replace("bodies:\n", f"bodies:\n{chain}")


def _alias(text: str, draw: random.Random) -> str:
    self_merge = "  a: &a {<<: *a, box: [0.1, 0.1, 0.1]}\n"
    endless = "  a: &a [*a, *a]\n"
    return text.replace("bodies:\n", f"bodies:\n{draw.choice((self_merge, endless))}")


def _tag(text: str, draw: random.Random) -> str:
    tag = draw.choice(
        ("!!python/object/apply:os.system ['true']", "!!binary aGk=", "!!set {a, b}", "!x y", "!!null ''")
    )
    return re.sub(r"goal: .*", f"goal: {tag}", text)


def _angle(text: str, draw: random.Random) -> str:
    return text.replace("90 deg", draw.choice(("'1" + " " * 60_000 + "x'", "'1" + " " * 60_000 + "deg'", "1e9 deg")))


def _many(text: str, draw: random.Random) -> str:
    same = draw.random() < 0.5
    bodies = "".join(
        f"  n{n}: {{sphere: 0.02, at: [{0 if same else n * 0.001}, 0, 1]}}\n" for n in range(draw.choice((300, 2500)))
    )
    return text.replace("goal:", f"{bodies}goal:")


def _mesh(text: str, draw: random.Random) -> str:
    name = draw.choice(("/dev/zero", "x" * 5000 + ".obj", "../p.yaml", "folder", "pipe", "loop", "p.yaml", "d.npz",
                        "~/x.obj", '"a\\0b.obj"', "http://x/y.obj", "brick.STL", "thing.obj:1"))  # fmt: skip
    return text.replace("thing.obj", name)


def _key(text: str, draw: random.Random) -> str:
    name = draw.choice(("name", "room", "bodies", "goal", "robot", "domain", "init", "metric", "samplers"))
    value = draw.choice(("null", "[]", "{}", "3", "'x'", "[[[]]]", "{a: {b: {c: d}}}", "*none", "&x *x", "~", "'('",
                         '"\\e[31m"', "[1, 2, 3]", "{on: uniform}", "{on: /etc/passwd}", "{on: mine.py}",
                         "'(on can'"))  # fmt: skip
    without = re.sub(rf"(?m)^{name}:.*(\n  .*)*\n", "", text)
    return without + f"{name}: {value}\n"


YAML_FAULTS = (_merges, _alias, _tag, _angle, _many, _mesh, _key, _key, _key)

SPOILERS: dict[str, Callable[[Any, random.Random, list[bytes]], bytes]] = {
    "json": spoil_json,
    "lines": spoil_lines,
    "text": spoil_text,
    "yaml": spoil_yaml,
    "binary": spoil_bytes,
    "arrays": spoil_arrays,
}
"""By a door's form; json, lines, text and yaml take text, the others bytes."""
