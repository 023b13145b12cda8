"""Files that are no YAML, too large or too deep are one error with its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.yaml_file import MAX_BYTES, read_yaml
from tamp.geometric.loading.yaml_nodes import MAX_DEPTH


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "p.yaml"


@pytest.mark.parametrize(
    ("content", "words", "line"),
    [
        (b"", "the file is empty", None),
        (b"# nothing but this\n", "the file is empty", None),
        (b"a: 1\nb: [1, 2\nc: 3\n", "not valid YAML", 3),
        (b"a: 1\n  b: 2\n", "not valid YAML: mapping values are not allowed", 2),
        (b"a: 1\n---\nb: 2\n", "not valid YAML: but found another document", 2),
        (b"a: *gone\n", "not valid YAML: found undefined alias", 1),
        (b"a: \xff\xfe\n", "cannot read the file: it is not UTF-8 text", None),
        (b"a: \x07\n", "not valid YAML", None),
    ],
)
def test_what_is_no_yaml_is_told_with_its_line(
    file: Path, content: bytes, words: str, line: int | None
) -> None:
    file.write_bytes(content)
    with pytest.raises(InputError, match=words) as told:
        read_yaml(file)
    assert told.value.file == str(file)
    assert line is None or told.value.line == line


def test_a_missing_file_and_a_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot read the file: No such file or directory"):
        read_yaml(tmp_path / "gone.yaml")
    with pytest.raises(InputError, match="cannot read the file: Is a directory"):
        read_yaml(tmp_path)


def test_a_file_beyond_the_limit_is_refused_and_one_at_it_is_read(file: Path) -> None:
    file.write_text("a: 1\n#" + "x" * (MAX_BYTES - 6))
    assert read_yaml(file).mapping()["a"].number() == 1.0
    file.write_text("a: 1\n#" + "x" * (MAX_BYTES - 5))
    with pytest.raises(InputError, match=r"no problem file is 1\.0 MB large"):
        read_yaml(file)


@pytest.mark.parametrize("depth", [MAX_DEPTH, MAX_DEPTH + 1])
def test_depth_is_limited(file: Path, depth: int) -> None:
    file.write_text("[" * depth + "]" * depth)
    if depth <= MAX_DEPTH:
        assert read_yaml(file).is_list()
    else:
        with pytest.raises(InputError, match=f"nested more than {MAX_DEPTH} deep"):
            read_yaml(file)


def test_the_root_has_no_name_and_the_first_line(file: Path) -> None:
    file.write_text("\n\na: 1\n")
    root = read_yaml(file)
    assert (root.name, root.line) == ("", 1)
    assert root.mapping()["a"].line == 3
