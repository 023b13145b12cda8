"""A YAML file as nodes that know their lines, read with limits on its size and depth."""

from __future__ import annotations

from pathlib import Path

import yaml

from tamp.errors import InputError
from tamp.geometric.loading.yaml_nodes import MAX_DEPTH, YamlNode

# libyaml's parser is ten times faster; it is missing only where PyYAML was built without it.
_Loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

MAX_BYTES = 1_000_000
"""Larger files are refused: they are something else, and would take long to say so."""


def read_yaml(file: Path) -> YamlNode:
    """Read the root of a YAML file with one document.

    Raises:
        InputError: It cannot be read, is not YAML, is empty, or holds a tag that is not plain data.
    """
    try:
        size = file.stat().st_size
        if size > MAX_BYTES:
            raise InputError(f"no problem file is {size / 1e6:.1f} MB large", file=file)
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise InputError(f"cannot read the file: {reason}", file=file) from None

    try:
        _check_depth(text, file)
        root = yaml.compose(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        what = error.problem or error.context or "not YAML"
        line, column = (None, None) if mark is None else (mark.line + 1, mark.column + 1)
        raise InputError(f"not valid YAML: {what}", file=file, line=line, column=column) from None
    except yaml.YAMLError as error:
        raise InputError(f"not valid YAML: {' '.join(str(error).split())}", file=file) from None
    except RecursionError:
        raise InputError("not valid YAML: nested too deeply", file=file) from None

    if root is None:
        raise InputError("the file is empty", file=file)
    return YamlNode(root, file, text.splitlines() or [""], "", 1)


def _check_depth(text: str, file: Path) -> None:
    """Refuse what libyaml could not compose without overflowing the stack, as it recurses."""
    depth = 0
    for event in yaml.parse(text, Loader=_Loader):
        if isinstance(event, yaml.CollectionStartEvent):
            depth += 1
            if depth > MAX_DEPTH:
                line, column = event.start_mark.line + 1, event.start_mark.column + 1
                raise InputError(
                    f"nested more than {MAX_DEPTH} deep", file=file, line=line, column=column
                )
        elif isinstance(event, yaml.CollectionEndEvent):
            depth -= 1
