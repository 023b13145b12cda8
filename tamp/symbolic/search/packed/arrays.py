"""Places of the compiled search's arrays: the task, the states, the open lists, scratch.

All lie in two arrays, one of whole numbers and one of reals, and a field of these tuples is the
place where its part begins, or a count: a compiled function that takes two arrays is called ten
times as fast as one that takes a hundred.

Lists of lists are compressed rows: row i of `x` is x[x_starts[i] : x_starts[i + 1]]. Sets of facts
are sparse masks: for each 64-bit word that they touch, its number and its bits.
"""

from __future__ import annotations

from typing import NamedTuple


class PackedTask(NamedTuple):
    """A task; conditions and effects over words.

    Attributes:
        words: Of a state.
        operators: How many there are, as `heuristics`, `always_count`, `strata` and `guards`.
        kinds: Heuristics: 0 ff, 1 landmarks, in the order in which they are asked.
        pre_starts: Conditions of operator i: words, what must be set and what must not.
        eff_starts: Effects of operator i: words, what is kept and what is added.
        con_starts: Conditional effects of operator i, each with condition and effect.
        pre_touched: For each operator the words of its conditions, one bit for each residue.
        eff_touched: Likewise those of its effects, the conditional ones too.
        watch_starts: For each fact the operators to try where it holds.
        always: Those to try everywhere.
        strata_starts: Axioms of each stratum, each with condition and head.
        costs: Of the operators, with the prices of their static facts.
        own: Without.
        guarded: Whether an operator has guards.
        fine_starts: For each guard the operators that it makes dearer, and by how much.
    """

    words: int
    operators: int
    heuristics: int
    always_count: int
    strata: int
    guards: int
    kinds: int
    pre_starts: int
    pre_words: int
    pre_need: int
    pre_absent: int
    eff_starts: int
    eff_words: int
    eff_keep: int
    eff_add: int
    con_starts: int
    con_pre_starts: int
    con_pre_words: int
    con_pre_need: int
    con_pre_absent: int
    con_eff_starts: int
    con_eff_words: int
    con_eff_keep: int
    con_eff_add: int
    pre_touched: int
    eff_touched: int
    watch_starts: int
    watch: int
    watch_mask: int
    always: int
    strata_starts: int
    recursive: int
    ax_pre_starts: int
    ax_pre_words: int
    ax_pre_need: int
    ax_pre_absent: int
    ax_word: int
    ax_bit: int
    goal_need: int
    goal_absent: int
    derived: int
    initial: int
    costs: int
    own: int
    guarded: int
    guard_starts: int
    guard_facts: int
    fine_starts: int
    fines: int
    fine_prices: int


class Relaxed(NamedTuple):
    """The relaxed task, see `heuristics.relaxation`; and the landmarks.

    Attributes:
        facts: Facts, complements, and keys: conditions that operators wait for to be removed.
        base: Facts and complements alone.
        operators: Relaxed operators, then those that remove a key's facts.
        first_remover: The first of those.
        effects_count: Effects of all, as `free_count`, `goal_count`, `negative_count`,
            `rise_count`, `keys`, `marks`; `mark_words` are the words of a set of landmarks.
        buckets: Costs below this many are whole numbers and go to buckets; others to a heap.
        key_starts: The facts of each key.
        member_starts: The operators that wait for it.
        rise_starts: For each guard the operators that pay for it in the relaxation.
        held_starts: For each operator the guards that it waits for there, and their keys.
        mark_facts: Landmarks: facts, and whether it is their complement.
    """

    facts: int
    base: int
    operators: int
    first_remover: int
    effects_count: int
    free_count: int
    goal_count: int
    negative_count: int
    rise_count: int
    keys: int
    marks: int
    mark_words: int
    buckets: int
    before_starts: int
    before: int
    effects_starts: int
    effects: int
    needs_starts: int
    needs: int
    waits: int
    free: int
    costs: int
    owners: int
    groups_starts: int
    groups: int
    goals: int
    negative_goals: int
    key_starts: int
    key_facts: int
    key_prices: int
    member_starts: int
    members: int
    remover_key: int
    rise_starts: int
    rises: int
    rise_prices: int
    held_starts: int
    held_guards: int
    held_keys: int
    held_prices: int
    mark_facts: int
    mark_absent: int
    mark_goal: int
    mark_weights: int
    mark_starts: int
    mark_needs: int


class Space(NamedTuple):
    """The closed states with a hash table, and the open lists: heaps over one pool of groups.

    Attributes:
        nodes: Room for so many states.
        groups: And so many groups of successors of one state, of one key each.
        pool: And so many members of groups.
        mask: The size of the hash table less one.
        root: For each state the last one on its way that made progress, see `open_lists.Plateau`.
        detour: How far it is from there.
        group_next: The member of each group whose turn is next, and the end of the members.
        group_base: What is added to a member's order.
        members: Order among the state's successors, in the upper half, and operator.
        member_cost: Of the way by it, with prices.
    """

    nodes: int
    groups: int
    pool: int
    mask: int
    table: int
    states: int
    marks: int
    parent: int
    operator: int
    evaluated: int
    root: int
    detour: int
    group_parent: int
    group_next: int
    group_end: int
    group_base: int
    ties: int
    items: int
    members: int
    cost: int
    spent: int
    values: int
    keys: int
    member_cost: int


class Scratch(NamedTuple):
    """The scratch of one expansion."""

    closed: int
    after: int
    other: int
    rooms: int
    on: int
    active: int
    supporters: int
    left: int
    heads: int
    tails: int
    entry_next: int
    entry_fact: int
    heap_ties: int
    heap_items: int
    seen: int
    paying: int
    plan: int
    in_plan: int
    applicable: int
    is_applicable: int
    helpful: int
    is_helpful: int
    ranks: int
    now: int
    remaining: int
    found: int
    found_order: int
    found_class: int
    class_size: int
    class_at: int
    extras: int
    raised: int
    reached: int
    totals: int
    costs: int
    heap_keys: int
    bounds: int
    provided: int
    chosen: int
    found_cost: int
    class_dearer: int
    class_paid: int
    class_step: int
