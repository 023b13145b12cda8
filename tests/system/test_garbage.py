"""How often garbage is collected: seldom while planning, hardly ever in a command, as before afterwards."""

from __future__ import annotations

import gc
import subprocess
import sys

import pytest

from tamp.system.garbage import HARDLY_EVER_CONTAINERS, SELDOM_CONTAINERS, infrequent_collection


@pytest.mark.parametrize(
    ("before", "inside"),
    [
        ((700, 10, 10), SELDOM_CONTAINERS),
        ((HARDLY_EVER_CONTAINERS, 5, 5), HARDLY_EVER_CONTAINERS),
        ((0, 10, 10), 0),
    ],
)
def test_seldom_is_no_oftener_than_before_and_is_put_back(
    before: tuple[int, int, int], inside: int
) -> None:
    own = gc.get_threshold()
    gc.set_threshold(*before)
    try:
        with infrequent_collection():
            assert gc.get_threshold() == (inside, *before[1:])
        assert gc.get_threshold() == before
    finally:
        gc.set_threshold(*own)


PLANNING = """
import atexit, gc, json
looks = []
gc.callbacks.append(lambda phase, info: looks.append(info["generation"]) if phase == "start" else None)
from tamp.system import guard

def main():
    looks.clear()
    from tamp.commands.solve import run
    code = run(["one_object", "--quiet", "--out", "plan.json"])
    print(len(looks), gc.get_threshold()[0])
    return code

if __name__ == "__main__":
    guard.guarded("__main__")
"""


def test_a_command_plans_without_a_look_for_garbage(tmp_path) -> None:
    words = [sys.executable, "-c", PLANNING]
    for _ in range(2):  # the first may compile kernels, after which there is a look
        done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True)
    looks, threshold = map(int, done.stdout.split())
    assert looks <= 1 and threshold == HARDLY_EVER_CONTAINERS
