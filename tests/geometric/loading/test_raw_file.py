"""Bytes are read from regular files alone, and never more than the limit."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tamp.errors import InputError
from tamp.geometric.loading.raw_file import read_raw


def test_a_file_at_the_limit_is_read_and_one_byte_more_is_not(tmp_path: Path) -> None:
    file = tmp_path / "some.bin"
    content = bytes(range(256)) * 4
    file.write_bytes(content)
    assert read_raw(file, len(content)) == content
    with pytest.raises(InputError, match=r"cannot read 'some.bin': it is larger than 0.001023 MB"):
        read_raw(file, len(content) - 1)


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("gone.obj", "there is no such file"),
        ("folder", "it is no regular file"),
        ("pipe", "it is no regular file"),
        ("dangling", "there is no such file"),
        ("zero\0byte", "it is no name of a file|there is no such file"),
    ],
)
def test_what_is_no_file_is_said_at_once(tmp_path: Path, name: str, why: str) -> None:
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "dangling").symlink_to("nowhere")
    with pytest.raises(InputError, match=why):
        read_raw(tmp_path / name, 100)


def test_a_link_to_a_file_is_one(tmp_path: Path) -> None:
    (tmp_path / "there").write_bytes(b"abc")
    (tmp_path / "link").symlink_to("there")
    assert read_raw(tmp_path / "link", 3) == b"abc"


def test_a_name_of_a_thousand_characters_is_told_by_its_beginning(tmp_path: Path) -> None:
    with pytest.raises(InputError) as told:
        read_raw(tmp_path / ("n" * 1000), 100)
    assert f"'{'n' * 77}...'" in told.value.message and len(told.value.message) < 200


def test_the_device_that_never_ends_is_not_read() -> None:
    with pytest.raises(InputError, match="it is no regular file"):
        read_raw(Path("/dev/zero"), 100)
