"""XML as people have it: encodings, byte order marks, blanks around it; and what is none."""

from __future__ import annotations

import codecs
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.xml_file import read_xml

TEXT = '<robot name="Grüße"><link/></robot>'


@pytest.mark.parametrize(
    "content",
    [
        TEXT.encode(),
        b'<?xml version="1.0"?>' + TEXT.encode(),
        b'\n\n  <?xml version="1.0" encoding="utf-8"?>\n' + TEXT.encode() + b"\n\0",
        codecs.BOM_UTF8 + TEXT.encode(),
        codecs.BOM_UTF16_LE + TEXT.encode("utf-16-le"),
        codecs.BOM_UTF16_BE
        + ('<?xml version="1.0" encoding="utf-16"?>' + TEXT).encode("utf-16-be"),
        b'<?xml version="1.0" encoding="ISO-8859-1"?>' + TEXT.encode("latin-1"),
        b"<?xml version='1.0' encoding='windows-1252'?>" + TEXT.encode("cp1252"),
        # It says one encoding, or none, and has another.
        b'<?xml version="1.0" encoding="utf-8"?>' + TEXT.encode("latin-1"),
        TEXT.encode("latin-1"),
    ],
    ids=range(10),
)
def test_text_is_read_in_whatever_encoding(tmp_path: Path, content: bytes) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(content)
    root = read_xml(file)
    assert (root.tag, root.get("name"), len(root)) == ("robot", "Grüße", 1)


def test_the_namespace_of_the_whole_file_is_no_part_of_names(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    text = '<robot xmlns="http://www.ros.org" xmlns:g="urn:g"><link/><g:link/></robot>'
    file.write_text(text, encoding="utf-8")
    root = read_xml(file)
    assert [root.tag, *(part.tag for part in root)] == ["robot", "link", "{urn:g}link"]


@pytest.mark.parametrize("encoding", ["rot13", "hex", "zip", "idna", "no-such"])
def test_an_encoding_that_is_no_text_is_not_obeyed(tmp_path: Path, encoding: str) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>{TEXT}'.encode())
    assert read_xml(file).get("name") == "Grüße"


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "cannot read 'r.urdf': no element found"),
        (b"<robot>", "cannot read 'r.urdf': no element found"),
        (b"<robot></link>", "cannot read 'r.urdf': mismatched tag: line 1, column"),
        (b"<robot/><robot/>", "junk after document element"),
        (b"solid cube\nfacet", "cannot read 'r.urdf': syntax error"),
        (b"<robot>&gone;</robot>", "undefined entity"),
    ],
)
def test_what_is_no_xml_is_said_with_its_place(tmp_path: Path, content: bytes, words: str) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(content)
    with pytest.raises(InputError, match=words):
        read_xml(file)


def test_the_limit_is_the_callers(tmp_path: Path) -> None:
    file = tmp_path / "r.urdf"
    file.write_bytes(TEXT.encode())
    assert read_xml(file, most=len(TEXT.encode())).tag == "robot"
    with pytest.raises(InputError, match="it is larger than"):
        read_xml(file, most=len(TEXT.encode()) - 1)
