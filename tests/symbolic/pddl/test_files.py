"""PDDL files: what is no file or no text is refused before it is read, comments may be in any encoding."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.symbolic.pddl.files import decoded, read_pddl
from tamp.symbolic.pddl.parser import parse_domain

CUTTING = """(define (domain saw)
 (:constants)
 (:types part)
 (:predicates (cut ?p - part))
 (:action saw :parameters (?p - part) :effect (cut ?p)))
"""


@pytest.mark.parametrize("encoding", ["latin-1", "cp1252", "shift-jis"])
def test_comments_in_any_encoding(encoding: str, tmp_path: Path) -> None:
    comment = {"latin-1": "Möbel, gesägt", "cp1252": "“sawn” – gesägt", "shift-jis": "鋸"}[encoding]
    file = tmp_path / "d.pddl"
    file.write_bytes(
        (f"; {comment}\n" + CUTTING.replace("(domain saw)", f"(domain saw) ; {comment}")).encode(
            encoding
        )
    )
    assert parse_domain(read_pddl(file), file).actions[0].name == "saw"


def test_names_in_another_encoding_are_refused_at_their_place(tmp_path: Path) -> None:
    file = tmp_path / "d.pddl"
    file.write_bytes(CUTTING.replace("cut", "säge").encode("latin-1"))
    with pytest.raises(
        InputError, match=r"d.pddl:4:17: cannot read it: it is not UTF-8 text. Save it as UTF-8"
    ):
        read_pddl(file)
    file.write_bytes(CUTTING.encode("utf-16"))
    with pytest.raises(InputError, match="UTF-16"):
        read_pddl(file)


@pytest.mark.parametrize("name", ["/dev/zero", "/dev/null", ".", "a\x00b"])
def test_what_is_no_file(name: str) -> None:
    with pytest.raises(InputError):
        read_pddl(Path(name))


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "d.pddl")
    with pytest.raises(InputError, match="this is a pipe, no PDDL file"):
        read_pddl(tmp_path / "d.pddl")


def test_a_comment_in_another_encoding_moves_no_line_and_no_column() -> None:
    text = decoded(b"(a) ; s\xe4gt\r\n(b) ; \xff\xfe\r(c)\n", Path("d.pddl"))
    assert text == "(a) ; s\ufffdgt\n(b) ; \ufffd\ufffd\n(c)\n"
    whole = "; sägt\r\n(a)"
    assert decoded(whole.encode(), Path("d.pddl")) == whole  # UTF-8 stays as it is
