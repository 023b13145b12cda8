"""How random problems are made."""

from __future__ import annotations

from tests.random_streams.conditions import DOWN, PURE, UP, Conditions, Scope
from tests.random_streams.oracle import Overflow, World
from tests.random_streams.problems import (
    MADE,
    THINGS,
    Act,
    Atom,
    Effect,
    Formula,
    Params,
    Problem,
    Rule,
    Source,
)


class Maker(Conditions):
    """Makes one problem, part by part."""

    def make(self) -> Problem:
        """All parts."""
        rng, problem = self.rng, self.problem
        problem.objects = {"a": "thing", "b": "thing", "s": "spot"}
        if rng.random() < 0.3:
            problem.objects["u"] = "spot"
        if rng.random() < 0.4:
            problem.objects["pose0"] = "pose"
        self.static()
        self.streams()
        self.fluents()
        for number in range(rng.choice((0, 1, 2, 2, 3))):
            self.rules(number)
        for number in range(rng.randint(1, 4)):
            self.act(number)
        for name, kinds in problem.predicates.items():
            if name in problem.fluents or name in ("st", "st2"):
                rows = list(self._rows(kinds))
                problem.init |= {
                    (name, *row)
                    for row in rows
                    if rng.random() < (0.3 if name in problem.fluents else 0.5)
                }
        return problem

    def static(self) -> None:
        self.declare("st", ("thing",), PURE)
        self.declare("st2", ("thing", "spot"), PURE)

    def streams(self) -> None:
        """A few, each resting on facts of lower levels only; several may certify the same."""
        rng = self.rng
        self.declare("is-thing", ("thing",), PURE)
        self.declare("is-spot", ("spot",), PURE)
        self.problem.init |= {
            (f"is-{kind}", name) for name, kind in self.problem.objects.items() if kind in THINGS
        }
        level: dict[str, int] = {"is-thing": 0, "is-spot": 0, "st": 0, "st2": 0}
        for number in range(rng.randint(2, 5)):
            made = [name for name in level if level[name]]
            names = rng.choices(
                [*level, *made, *made], k=1 if number == 0 else rng.choice((1, 1, 2))
            )
            scope: Scope = {}
            domain = tuple(self.anchor(name, scope, 0.6) for name in names)
            inputs = tuple(scope.items())
            height = 1 + max(level[name] for name in names)
            sizes = (1, 1, 2) if number == 0 else (0, 0, 0, 1, 1, 2)
            outputs = tuple((f"?o{i}", rng.choice(MADE)) for i in range(rng.choice(sizes)))
            state = number > 1 and rng.random() < 0.12
            if state:
                outputs = tuple((name, "way") for name, _ in outputs[:1])
            certified: list[Atom] = []
            narrow = rng.sample(inputs, min(len(inputs), 3 - len(outputs)))
            for which in range(1 if rng.random() < 0.6 else 2):
                some = tuple(pair for pair in narrow if rng.random() < 0.8) or narrow
                params = (*some, *outputs)
                kinds = tuple(kind for _, kind in params)
                old = [
                    p
                    for p, at in level.items()
                    if at == height and self.problem.predicates[p] == kinds and not state
                ]
                if old and rng.random() < 0.6:
                    name = rng.choice(old)
                else:
                    name = f"w{number}-{which}" if state else f"c{number}-{which}"
                    self.declare(name, kinds, UP)
                    if not state:
                        level[name] = height
                certified.append((name, *(name for name, _ in params)))
            prefix = "plan" if state else "sample" if outputs else "test"
            self.problem.sources.append(
                Source(
                    f"{prefix}-{number}",
                    inputs,
                    domain,
                    outputs,
                    tuple(dict.fromkeys(certified)),
                    ("f0", "f1") if state else (),
                )
            )
        for name in [name for name, at in level.items() if at]:
            if (
                "pose0" in self.problem.objects
                and "pose" in self.problem.predicates[name]
                and rng.random() < 0.5
            ):
                rows = list(self._rows(self.problem.predicates[name]))
                self.problem.init |= {(name, *row) for row in rows if rng.random() < 0.3}

    def fluents(self) -> None:
        rng = self.rng
        for number in range(rng.randint(2, 4)):
            size = rng.choice((0, 1, 1, 2, 2))
            self.declare(
                f"f{number}",
                [rng.choice((*THINGS, *MADE, "thing", "pose", "pose")) for _ in range(size)],
                PURE,
            )
            self.problem.fluents.append(f"f{number}")

    def rules(self, number: int) -> None:
        """A derived predicate; it may rest on itself."""
        rng = self.rng
        name, kind = f"d{number}", rng.choice((PURE, UP, UP, UP, DOWN, DOWN))
        kinds = [rng.choice((*THINGS, *MADE)) for _ in range(rng.choice((0, 1, 1, 2)))]
        params = tuple((f"?h{i}", one) for i, one in enumerate(kinds))
        head = (name, *(name for name, _ in params))
        for _ in range(rng.choice((1, 1, 2))):
            inner: Scope = dict(params)
            names = rng.choices(self.generating(kind != DOWN), k=rng.randint(1, 2))
            if kind == UP and rng.random() < 0.6:
                names = self.tied() or names
            anchors = [self.anchor(one, inner, 0.85) for one in names]
            if kind == PURE:
                anchors = [atom for atom in anchors if self.kinds[atom[0]] == PURE]
                inner = {
                    term: k
                    for term, k in inner.items()
                    if any(term in atom for atom in anchors) or (term, k) in params
                }
            parts: list[Formula] = [
                *anchors,
                *(
                    self.formula(dict(inner), 1, kind != DOWN, kind == PURE)
                    for _ in range(rng.choice((0, 1, 1)))
                ),
            ]
            rng.shuffle(parts)
            new = tuple(pair for pair in inner.items() if pair not in params)
            body: Formula = ("and", *parts)
            self.problem.rules.append(Rule(head, params, ("exists", new, body) if new else body))
        self.declare(name, kinds, kind)
        if len(kinds) > 0 and kind != DOWN and rng.random() < 0.3:
            inner = {"?h0": kinds[0]}
            links = [
                p
                for p in self.generating(kind != DOWN)
                if self.problem.predicates[p] == (kinds[0], kinds[0])
                and (kind == UP or self.kinds[p] == PURE)
            ]
            if links:
                link = rng.choice(links)
                step = ("and", (link, "?h0", "?k"), (name, "?k", *(p for p, _ in params[1:])))
                self.problem.rules.append(Rule(head, params, ("exists", (("?k", kinds[0]),), step)))

    def tied(self) -> list[str]:
        """A certified predicate and a fluent one about the same kind of value: "what is there was tested"."""
        predicates = self.problem.predicates
        pairs = [
            [certified, fluent]
            for certified in predicates
            for fluent in self.problem.fluents
            if certified[0] == "c"
            and set(predicates[certified]) & set(predicates[fluent]) & set(MADE)
        ]
        return self.rng.choice(pairs) if pairs else []

    def act(self, number: int) -> None:
        """An action with a precondition that says where its arguments come from."""
        rng = self.rng
        scope: Scope = {}
        known = self.generating(True, state=True)
        known += 3 * [name for name in known if name[0] == "d"]
        names = rng.choices(known, k=rng.randint(1, 3))
        parts: list[Formula] = [self.anchor(name, scope, 0.65) for name in names]
        if rng.random() < 0.15:
            scope[f"?e{number}"] = rng.choice(THINGS)
        parts += [self.formula(dict(scope), 1, True) for _ in range(rng.choice((0, 0, 1, 1, 2)))]
        rng.shuffle(parts)
        effects: list[Effect] = []
        for _ in range(rng.randint(1, 3)):
            params: Params = ()
            inner = dict(scope)
            condition: Formula = ("and",)
            if rng.random() < 0.25:
                params = (("?z", rng.choice((*THINGS, *MADE))),)
                inner.update(params)
            atom = self.fluent(inner)
            if atom is None:
                continue
            adds = rng.random() < 0.65
            if params and params[0][1] in MADE:
                guard = self.mentioning("?z", inner)
                if guard is None:
                    continue
                condition = guard
            elif rng.random() < 0.35:
                condition = self.formula(inner, 1, True, pure=True)
            effects.append(Effect(atom, adds, condition, params))
        cost: float | Atom = rng.choice((1.0, 1.0, 2.0))
        values = [term for term, kind in scope.items() if kind == "pose"]
        if values and rng.random() < 0.2:
            self.problem.functions["price"] = "pose"
            cost = ("price", rng.choice(values))
        self.problem.acts.append(
            Act(f"act{number}", tuple(scope.items()), ("and", *parts), tuple(effects), cost)
        )

    def aim(self, any_goal: bool) -> bool:
        """Choose a goal that holds after some random actions; or one that may be out of reach. Whether there is one."""
        rng, problem = self.rng, self.problem
        world = World(problem)
        state, taken = world.initial, list[tuple[str, ...]]()
        first = world.model(state)
        for _ in range(rng.randint(1, 6)):
            after = [(values, new) for _, values, new in world.successors(state) if new != state]
            if not after:
                break
            values, state = rng.choice(after)
            taken.append(values)
        last = world.model(state)
        self.words = list(problem.objects)
        tries = [self.formula({}, rng.choice((0, 1, 1, 2)), True) for _ in range(40)]
        for name in 3 * self.generating(True, state=True):
            scope: Scope = {}
            atom = self.anchor(name, scope, 0.5)
            tries.append(("exists", tuple(scope.items()), atom) if scope else atom)
        rng.shuffle(tries)
        new = [formula for formula in tries if not world.holds(formula, {}, first)]
        reached = [formula for formula in new if world.holds(formula, {}, last)]
        made = any(value not in problem.objects for values in taken for value in values)
        if reached and made and rng.random() < 0.85:
            problem.goal = ("and", *reached[: rng.choice((1, 1, 2, 3))])
            return True
        problem.goal = ("and", *new[:1])
        return bool(new) and (any_goal or (bool(taken) and rng.random() < 0.3))


ATTEMPTS = 30
"""Problems that are made before one is taken in which nothing can be done."""


def random_problem(seed: int) -> Problem:
    """A small problem; in most of them there is something to do, with values from streams, and a goal to reach."""
    for attempt in range(10 * ATTEMPTS):
        maker = Maker(1000 * seed + attempt)
        maker.make()
        try:
            if maker.aim(attempt >= ATTEMPTS):
                return maker.problem
        except Overflow:
            continue
    raise ValueError(f"no small problem with the seed {seed}")
