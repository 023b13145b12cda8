"""XML files as people have them: blank lines before the declaration, other encodings, something
after the end.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree
from xml.parsers import expat

from tamp.errors import InputError
from tamp.geometric.loading.raw_file import read_raw

MOST_BYTES = 20_000_000
"""Larger files are no description of a body; drawings in COLLADA have a limit of their own."""

_DECLARED = re.compile(rb"""^<\?xml[^>]*?encoding\s*=\s*["']([A-Za-z0-9._-]+)["'][^>]*\?>""")
# Of the others, some are no text, and some take quadratic time.
_TEXT_ENCODINGS = re.compile(
    r"(utf|ucs|us-ascii|ascii|iso[-_]?8859|latin|windows-?125|cp\d|gb|big5|shift|sjis|euc|koi8"
    r"|mac)",
    re.IGNORECASE,
)
_PREFIX = re.compile(r"[<\s/]([A-Za-z_][\w.-]*):[A-Za-z_]")
_ROOT = re.compile(r"<[A-Za-z_][\w.:-]*")
_BLANK = " \t\r\n\0\ufeff"
_BOMS = ((b"\xef\xbb\xbf", "utf-8"), (b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be"))


def read_xml(path: Path, most: int = MOST_BYTES) -> ElementTree.Element:
    """Read the root element of an XML file.

    Text that is not of the encoding that it declares (UTF-8 when it declares none) is read as
    Latin-1: names of parts and materials are all that can suffer. The root's own namespace is no
    part of names: descriptions with `xmlns=` are read as those without.

    Args:
        path: The file.
        most: Bytes beyond which it is refused.

    Raises:
        InputError: It cannot be read, is too large, or is not XML.
    """
    text = _bare(_decoded(read_raw(path, most)))
    try:
        try:
            root = ElementTree.fromstring(text)
        except ElementTree.ParseError as error:
            if "unbound prefix" not in str(error):
                raise
            root = ElementTree.fromstring(_bound(text))
        return _plain(root)
    except (ElementTree.ParseError, ValueError) as error:
        raise InputError(f"cannot read '{path.name}': {error}") from None
    except RecursionError:
        raise InputError(f"cannot read '{path.name}': nested too deeply") from None


def read_numbered_xml(
    path: Path, most: int = MOST_BYTES
) -> tuple[ElementTree.Element, dict[ElementTree.Element, int]]:
    """Read the root element of an XML file, and the line of each element in it, 1-based.

    Raises:
        InputError: As `read_xml`, with the file.
    """
    try:
        root = read_xml(path, most)
    except InputError as error:
        raise error.at(path) from None
    text = _decoded(read_raw(path, most))
    before = text[: len(text) - len(text.lstrip(_BLANK))].count("\n")
    lines: list[int] = []
    parser = expat.ParserCreate()
    parser.StartElementHandler = lambda *_: lines.append(before + parser.CurrentLineNumber)
    parser.Parse(_bare(text), True)
    return root, dict(zip(root.iter(), lines, strict=True))


def _plain(root: ElementTree.Element) -> ElementTree.Element:
    """Take the root's namespace off all names in it."""
    space, bracket, _ = root.tag.rpartition("}")
    if bracket:
        for element in root.iter():
            if isinstance(element.tag, str):
                element.tag = element.tag.removeprefix(space + bracket)
    return root


def _bound(text: str) -> str:
    """Declare the prefixes that a file uses without: descriptions of robots name a simulator's."""
    used = set(_PREFIX.findall(text)) - {"xml", "xmlns"}
    new = sorted(name for name in used if f"xmlns:{name}" not in text)
    names = "".join(f' xmlns:{name}="urn:{name}"' for name in new)
    return _ROOT.sub(lambda root: root[0] + names, text, count=1)


def _decoded(content: bytes) -> str:
    """Return the text of a file without byte order mark."""
    encoding = "utf-8"
    for mark, name in _BOMS:
        if content.startswith(mark):
            content, encoding = content[len(mark) :], name
            break
    else:
        declared = _DECLARED.match(content.lstrip())
        if declared and _TEXT_ENCODINGS.match(declared[1].decode()):
            encoding = declared[1].decode()
    try:
        return content.decode(encoding)
    except (UnicodeError, LookupError):
        return content.decode("latin-1")


def _bare(text: str) -> str:
    """Return a text without its declaration, and without blanks or zero bytes at its ends."""
    # pybullet's own files begin with a blank line and end with a zero byte; neither is XML.
    return re.sub(r"^<\?xml[^>]*\?>", "", text.strip(_BLANK), count=1)
