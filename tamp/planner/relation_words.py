"""Relations of the user's own in words: "upright", "left_of mug"."""

from __future__ import annotations

import re

from tamp.planner.solution import Solution


def relation_words(solution: Solution) -> dict[tuple[str, str], str]:
    """Map body and pose names to what the goal's relations of one's own say of that pose, as far as
    a plan's facts certify it.
    """
    problem, words = solution.problem, dict[tuple[str, str], list[str]]()
    wanted = {*re.findall(r"[^\s()]+", problem.goal.lower())}
    for name, relation in problem.relations.items():
        own = [pose for pose, body in relation.poses.items() if body == relation.arguments[0]]
        if name not in wanted or not own:
            continue
        terms = {atom.predicate: atom.terms for atom in relation.facts}

        for predicate, *values in sorted(solution.certified):
            if predicate in terms and len(values) == len(terms[predicate]):
                bound = dict(zip(terms[predicate], values, strict=True))
                body, *others = (bound[variable] for variable in relation.arguments)
                said = words.setdefault((body, bound[own[0]]), [])
                said.append(" ".join([name, *others]))

    return {key: ", ".join(dict.fromkeys(said)) for key, said in words.items()}
