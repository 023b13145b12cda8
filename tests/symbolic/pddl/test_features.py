"""Features that tamp does not have are refused by the names that PDDL gives them."""

from __future__ import annotations

from tamp.symbolic.pddl.features import FEATURES, lacking, sections, unsupported


def test_features_are_named_as_the_user_wrote_them() -> None:
    assert unsupported("always") == "'always' is not supported: tamp has no trajectory constraints"
    assert unsupported("always", "Always").startswith("'Always' is not supported")
    assert (
        lacking("(= a 3)", "numeric fluents")
        == "'(= a 3)' is not supported: tamp has no numeric fluents"
    )
    assert ":process" in sections(()) and ":process" not in sections((":process",))
    assert all(word.startswith(":") and word in FEATURES for word in sections(()))
