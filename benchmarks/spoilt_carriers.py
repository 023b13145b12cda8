"""Plans in which bodies carry others, or learned relations hold, spoilt on purpose: does the judge reject each?

python -m benchmarks.spoilt_carriers set_table stack_learned pack_learned stack pack tray --seeds 5
"""

from __future__ import annotations

import copy
import json
import re
import tempfile
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import tyro

from benchmarks.common import record, table

Plan = dict[str, Any]
Spoil = Callable[[Plan, np.random.Generator], bool]
"""Spoils a plan, and says whether there was something to spoil."""


@dataclass(frozen=True)
class Options:
    """What to judge.

    Attributes:
        problems: Shipped problems' names or paths.
        seeds: Seeds first, first + 1, ... of each problem: of the plan and of what is spoilt.
        first: The first seed.
        time: Budget of planning, seconds on the clock.
        out: The name of the file under benchmarks/results.
    """

    problems: tyro.conf.Positional[tuple[str, ...]] = (
        "set_table", "stack_learned", "pack_learned", "stack", "pack", "tray",
    )  # fmt: skip
    seeds: int = 5
    first: int = 0
    time: float = 30.0
    out: str = "spoilt_carriers.jsonl"


def blocks(plan: Plan) -> list[tuple[str, str, list[Plan]]]:
    """What is carried, in order: the body, its pose at the end, and the actions from the way there to the last."""
    found: list[tuple[str, str, list[Plan]]] = []
    actions: list[Plan] = []
    for action in plan["actions"]:
        actions.append(action)
        if action["name"] in ("place", "place-on"):
            found.append((*action["arguments"][:2], actions))
            actions = []
    return found


def poses_at_the_end(plan: Plan) -> dict[str, str]:
    """The name of each body's pose at the end."""
    at = {fact[1]: fact[2] for fact in plan["initial"] if fact[0] == "at-pose"}
    for action in plan["actions"]:
        if action["name"] in ("place", "place-on"):
            at[action["arguments"][0]] = action["arguments"][1]
        elif action["name"] == "alight":
            at[action["arguments"][0]] = action["arguments"][-1]
    return at


def needed(plan: Plan) -> set[str]:
    """Bodies to which another one is related at the end: borne by it, beside it, between it and a third."""
    at = poses_at_the_end(plan)
    found: set[str] = set()
    for name, *terms in plan["certified"]:
        bodies = [one for one in terms if one in at]
        if (name == "borne" or name.endswith("-pose")) and all(at[one] in terms for one in bodies):
            found |= {*bodies[1:]}
    return found


def _any(names: set[str] | list[str], rng: np.random.Generator) -> str:
    return sorted(names)[int(rng.integers(len(names)))]


def _attached_loads(plan: Plan) -> list[Plan]:
    segments = [one for action in plan["actions"] for one in action["segments"]]
    return [one["attach"] for one in segments if one.get("attach", {}).get("load")]


def tilted(plan: Plan, rng: np.random.Generator) -> bool:
    """The hand turns what carries others by 17 to 34 degrees on its way, and back."""
    carriers = {one["body"] for one in _attached_loads(plan)}
    segments = [one for action in plan["actions"] for one in action["segments"]]
    carrying = [one for one in segments if one["part"] == "arm" and one.get("holding") in carriers]
    lean = float(rng.uniform(0.3, 0.6))
    for segment in carrying:
        swing = lean * np.sin(np.linspace(0.0, np.pi, len(segment["positions"])))
        for row, angle in zip(segment["positions"], swing, strict=True):
            row[5] += angle
    return bool(carrying)


def left_behind(plan: Plan, rng: np.random.Generator) -> bool:
    """One of what rides is not carried along: no action says so, or the hand's load leaves it out."""
    riders = {one["arguments"][0] for one in plan["actions"] if one["name"] == "ride"}
    if not riders:
        return False
    one = _any(riders, rng)
    if rng.random() < 0.5:
        plan["actions"] = [
            action
            for action in plan["actions"]
            if action["name"] not in ("ride", "alight") or action["arguments"][0] != one
        ]
        return True
    for attach in _attached_loads(plan):
        attach["load"] = [load for load in attach["load"] if load["body"] != one]
    return True


def support_left_out(plan: Plan, rng: np.random.Generator) -> bool:
    """A body to which another one is related is never fetched."""
    wanted = needed(plan) & {body for body, _, _ in blocks(plan)}
    if not wanted:
        return False
    one = _any(wanted, rng)
    plan["actions"] = [action for body, _, actions in blocks(plan) if body != one for action in actions]
    return True


def support_elsewhere(plan: Plan, rng: np.random.Generator) -> bool:
    """A body to which another one is related is said to end 6 to 30 cm from where it does."""
    wanted = needed(plan)
    if not wanted:
        return False
    way, far = rng.uniform(-np.pi, np.pi), rng.uniform(0.06, 0.3)
    position = plan["values"][poses_at_the_end(plan)[_any(wanted, rng)]]["position"]
    position[0] += far * np.cos(way)
    position[1] += far * np.sin(way)
    return True


def out_of_order(plan: Plan, rng: np.random.Generator) -> bool:
    """What stands on a body is put there before that body is."""
    carried = blocks(plan)
    order = [body for body, _, _ in carried]
    at = poses_at_the_end(plan)
    borne = [
        (fact[1], fact[3])
        for fact in plan["certified"]
        if fact[0] == "borne" and (at[fact[1]], at[fact[3]]) == (fact[2], fact[4]) and {fact[1], fact[3]} <= {*order}
    ]
    if not borne:
        return False
    above, below = borne[int(rng.integers(len(borne)))]
    one, other = order.index(below), order.index(above)
    carried[one], carried[other] = carried[other], carried[one]
    plan["actions"] = [action for _, _, actions in carried for action in actions]
    return True


SPOIL: dict[str, Spoil] = {
    "tilted": tilted, "left behind": left_behind, "support left out": support_left_out,
    "support elsewhere": support_elsewhere, "out of order": out_of_order,
}  # fmt: skip
OF_LEARNED = re.compile(r"\((stack|pack|left_of|between) ([^()]*)\)")
"""A learned relation in a goal, and its arguments."""


def forged(honest: Plan, seed: int, limit: float) -> Plan | None:
    """A plan that puts a body anywhere on the table, and says that the goal's learned relation holds of it there.

    All its motions are sound: what is wrong is that one certificate. None where the goal wants no such relation, or no
    plan was found.

    Args:
        honest: A plan that makes it hold.
        seed: Which of the goal's relations it is, and of the plan.
        limit: Budget of planning, seconds on the clock.
    """
    import tamp
    from grounding.registry import GROUNDINGS
    from tamp.plan.write import plan_document

    wanted = OF_LEARNED.findall(honest["goal"])
    if not wanted:
        return None
    relation, terms = wanted[seed % len(wanted)]
    bodies = terms.split()
    easier = honest["goal"].replace(f"({relation} {terms})", f"(on {bodies[0]} table)")
    file = Path(honest["inputs"]["problem"]["path"])
    text = re.sub(r"goal: .*", f"goal: {easier}", file.read_text(encoding="utf-8"))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / file.name
        path.write_text(text, encoding="utf-8")
        solution = tamp.solve(tamp.load_problem(path, registry=GROUNDINGS), max_time=limit, seed=seed)
        if not solution.solved:
            return None
        plan = plan_document(solution)

    plan["inputs"], plan["goal"] = honest["inputs"], honest["goal"]
    at = poses_at_the_end(plan)
    said = [term for body in bodies for term in (body, at[body])]
    plan["certified"].append([f"{relation}-pose", *said])
    return plan


def spoilt(plan: Plan, name: str, rng: np.random.Generator) -> Plan | None:
    """A spoilt copy of a plan; None where there is nothing to spoil in this way."""
    copied = copy.deepcopy(plan)
    return copied if SPOIL[name](copied, rng) else None


def main(options: Options) -> None:
    """Judge, print what is not rejected, write."""
    import tamp
    from grounding.registry import GROUNDINGS
    from tamp.plan.write import plan_document
    from tamp.verification.verify import verify

    rows: list[dict[str, Any]] = []
    for name in options.problems:
        problem = tamp.load_problem(name, registry=GROUNDINGS)
        tried: Counter[str] = Counter()
        rejected: Counter[str] = Counter()
        for seed in range(options.first, options.first + options.seeds):
            solution = tamp.solve(problem, max_time=options.time, seed=seed)
            if not solution.solved:
                print(f"  {name} seed {seed}: no plan", flush=True)
                continue
            document = json.loads(json.dumps(plan_document(solution)))
            cases: dict[str, Plan | None] = {"as it is": document}
            cases |= {kind: spoilt(document, kind, np.random.default_rng([seed, 7])) for kind in SPOIL}
            cases["forged"] = forged(document, seed, options.time)
            for kind, plan in cases.items():
                if plan is None:
                    continue
                report = verify(plan, classifiers=problem.classifiers)
                tried[kind] += 1
                rejected[kind] += not report.holds
                config = {"problem": name, "spoilt": kind}
                record(options.out, seed=seed, config=config, holds=report.holds, said=report.text())
                if report.holds != (kind == "as it is"):
                    print(f"  {name} seed {seed} {kind}: {report.text()}", flush=True)
        rows.append(
            {"problem": Path(name).stem}
            | {kind: f"{rejected[kind]} of {tried[kind]}" for kind in ("as it is", *SPOIL, "forged")}
        )
        print(rows[-1], flush=True)
    table(rows, "rejected by the judge")


if __name__ == "__main__":
    main(tyro.cli(Options, description=(__doc__ or "").splitlines()[0]))
