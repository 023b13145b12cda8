"""XML files as people have them: blank lines before the declaration, other encodings, something
after the end.
"""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

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
_BOMS = ((b"\xef\xbb\xbf", "utf-8"), (b"\xff\xfe", "utf-16-le"), (b"\xfe\xff", "utf-16-be"))


def read_xml(path: Path, most: int = MOST_BYTES) -> ElementTree.Element:
    """Read the root element of an XML file.

    Text that is not of the encoding that it declares (UTF-8 when it declares none) is read as
    Latin-1: names of parts and materials are all that can suffer.

    Args:
        path: The file.
        most: Bytes beyond which it is refused.

    Raises:
        InputError: It cannot be read, is too large, or is not XML.
    """
    text = _text(read_raw(path, most))
    try:
        try:
            return ElementTree.fromstring(text)
        except ElementTree.ParseError as error:
            if "unbound prefix" not in str(error):
                raise
            return ElementTree.fromstring(_bound(text))
    except (ElementTree.ParseError, ValueError) as error:
        raise InputError(f"cannot read '{path.name}': {error}") from None
    except RecursionError:
        raise InputError(f"cannot read '{path.name}': nested too deeply") from None


def _bound(text: str) -> str:
    """Declare the prefixes that a file uses without: descriptions of robots name a simulator's."""
    used = set(_PREFIX.findall(text)) - {"xml", "xmlns"}
    new = sorted(name for name in used if f"xmlns:{name}" not in text)
    names = "".join(f' xmlns:{name}="urn:{name}"' for name in new)
    return _ROOT.sub(lambda root: root[0] + names, text, count=1)


def _text(content: bytes) -> str:
    """Return the text of the file without byte order mark, declaration, and blanks or zero bytes at
    its ends.
    """
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
        text = content.decode(encoding)
    except (UnicodeError, LookupError):
        text = content.decode("latin-1")
    # pybullet's own files begin with a blank line and end with a zero byte; neither is XML.
    text = text.strip(" \t\r\n\0\ufeff")
    return re.sub(r"^<\?xml[^>]*\?>", "", text, count=1)
