"""Shapes of arrays stand in the geometric wing's signatures; the tests check them, and the product pays nothing."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from tests.shape_checks import instrumented, names_shapes

UNCHECKED = "TAMP_TESTS_NO_SHAPES" in os.environ
COMPILED = ("njit", "compiled", "jit")
WITHOUT_A_SHAPE = {
    ("fcl_pairs.py", "__init__"),  # of pairs in a list: the list's type says it
    ("robot_arrays.py", "read_arrays"),  # of whatever shape: `numbers` checks it
    ("robot_arrays.py", "numbers"),
}


def public_functions(tree: ast.Module) -> Iterator[ast.FunctionDef]:
    for node in tree.body:
        inner = (
            node.body
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_")
            else [node]
        )
        for one in inner:
            if isinstance(one, ast.FunctionDef) and not (
                one.name.startswith("_") and not one.name.startswith("__")
            ):
                yield one


def test_public_functions_name_the_shapes_of_their_arrays(root: Path) -> None:
    shaped, bare = 0, list[str]()
    for path in sorted((root / "tamp" / "geometric").rglob("*.py")):
        for function in public_functions(ast.parse(path.read_text(encoding="utf-8"))):
            if any(
                word in ast.unparse(one) for one in function.decorator_list for word in COMPILED
            ):
                continue
            arguments = [one.annotation for one in (*function.args.args, *function.args.kwonlyargs)]
            for annotation in (*arguments, function.returns):
                text = "" if annotation is None else ast.unparse(annotation)
                if (
                    "Array" in text
                    and not text.startswith("Callable")
                    and (path.name, function.name) not in WITHOUT_A_SHAPE
                ):
                    shaped += names_shapes(annotation)
                    if not names_shapes(annotation):
                        bare.append(f"{path.name}: {function.name}: {text}")
    assert shaped > 150
    assert not bare, "\n".join(bare)


@pytest.mark.parametrize("shape", [(3, 4), (4,), (1, 4, 4)])
def test_a_wrong_shape_is_refused(shape: tuple[int, ...]) -> None:
    if UNCHECKED:
        pytest.skip("shapes are not checked")
    from jaxtyping import TypeCheckError

    from tamp.geometric.scene.pose import Pose

    with pytest.raises(TypeCheckError, match="4 4"):
        Pose.from_matrix(np.zeros(shape))


def test_one_name_is_one_length_in_a_call() -> None:
    if UNCHECKED:
        pytest.skip("shapes are not checked")
    from jaxtyping import TypeCheckError

    from tamp.geometric.motion.path import edge_lengths

    assert edge_lengths(np.zeros((4, 3)), np.ones(3)).shape == (3,)
    with pytest.raises(TypeCheckError):
        edge_lengths(np.zeros((4, 3)), np.ones(1))


def test_a_checked_module_keeps_its_lines() -> None:
    source = (
        "from __future__ import annotations\n\nimport numpy as np\n\n\n"
        'def f(x: Float[Array, "n 2"], where: Unknown) -> Float[Array, " n"]:\n    raise ValueError(x)\n'
    )
    names: dict[str, object] = {}
    exec(instrumented(source, "made.py"), names)
    function = names["f"]
    with pytest.raises(ValueError, match="0") as raised:
        function(np.zeros((3, 2)), None)  # type: ignore[operator]
    assert raised.traceback[-1].lineno == 6  # counted from 0
    with pytest.raises(Exception, match="n 2"):
        function(np.zeros((3, 3)), None)  # type: ignore[operator]


def test_the_product_imports_neither_of_the_two(root: Path) -> None:
    program = (
        "import sys; sys.modules['jaxtyping'] = sys.modules['beartype'] = None\n"
        "import tamp; print(len(tamp.load_problem('one_object').scene.bodies))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, cwd=root, check=False
    )
    assert done.returncode == 0 and int(done.stdout) > 0, done.stderr
