"""The grammar of PDDL's groups: the items that each may contain, as far as parentheses can be
judged by it.
"""

from __future__ import annotations

MOST_GROUPS = {
    "not": 1,
    "exists": 2,
    "forall": 2,
    "when": 2,
    "imply": 2,
    "increase": 2,
    "=": 2,
    ":derived": 2,
}
"""How many parenthesised parts these take."""
ONLY_GROUPS = frozenset(
    (
        "and",
        "or",
        "not",
        "exists",
        "forall",
        "when",
        "imply",
        ":derived",
        ":predicates",
        ":init",
        ":goal",
    )
)
MANY_GROUPS = frozenset(
    ("and", "or", ":predicates", ":init", ":goal", ":functions", ":function", ":axiom", ":metric")
)
KEYWORDED = frozenset((":action", ":stream", ":wild-stream", ":rule"))
"""Sections with a name and `:keyword value` pairs."""


def may_contain(head: str, groups: int, item: str, item_head: str, previous: str) -> bool:
    """Check that an item may stand inside a group.

    Args:
        head: The group's first word; "(" when it begins with a group.
        groups: How many groups it already holds.
        item: The item's first token, "(" for a group.
        item_head: The first word of an item that is a group.
        previous: The token before the item.
    """
    if head in ("(", ")"):
        return True
    if head == "total-cost":
        return False
    if item != "(":
        if item.startswith(":"):
            return head.startswith(":")
        if head in KEYWORDED:
            return previous == head  # the name
        return head not in ONLY_GROUPS and not (head == "define" and previous != "(")
    if item_head == "define":
        return False
    if item_head.startswith(":"):
        return head == "define"
    if head == "define":
        return previous == head  # (domain NAME)
    if head in MOST_GROUPS:
        return groups < MOST_GROUPS[head]
    if head in KEYWORDED:
        return previous.startswith(":") and previous != head
    # The rest are facts, lists of variables and lists of names: they hold words, and types such as
    # (either a b).
    return head in MANY_GROUPS or item_head == "either"
