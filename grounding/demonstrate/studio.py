"""The session behind the page: one relation, one scene at a time, a folder of demonstrations."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from grounding.demonstrate.folder import DemonstrationFolder, SceneSource
from grounding.demonstrate.hints import contradicted
from grounding.demonstrate.message import Message, read_angle, read_poses, read_word
from grounding.demonstrate.opinion import Opinion
from grounding.demonstrate.questions import telling_stages
from grounding.demonstrate.records import in_arguments, records
from grounding.demonstrate.relation import DemonstratedRelation, parse_relation
from grounding.demonstrate.runner import Runner
from grounding.demonstrate.scene import Stage, choices_of, open_stage, sample_stage, shuffled
from grounding.demonstrate.stage_document import flat, stage_document
from grounding.demonstrate.thumbnail import thumbnail
from grounding.demonstrate.use import Uses, write_problem
from grounding.demonstrate.workbench import Trouble, Workbench
from grounding.relations.demonstration_file import Demonstration, Label
from tamp.errors import InputError, printable
from tamp.geometric.scene.pose import Pose
from tamp.view.page import harmless


class Studio:
    """The state of a session, changed by what the page sends. Threads take turns.

    Args:
        relation: What is demonstrated first.
        source: Where scenes and demonstrations come from.
        workbench: The physics.
        runner: Runs the commands that learn and plan.
        seed: Of the generated scenes.

    Raises:
        InputError: The folder or the scene is not what is needed.
    """

    def __init__(
        self,
        relation: DemonstratedRelation,
        source: SceneSource,
        workbench: Workbench,
        runner: Runner,
        seed: int = 0,
    ) -> None:
        self._source, self._bench, self._runner = source, workbench, runner
        self._opinion = Opinion()
        self._asked: list[Stage] | None = None
        self._chosen: dict[str, str] = {}
        self._lock = threading.RLock()
        self.relation = relation
        self.folder = DemonstrationFolder(source.folder(relation), relation)
        # Who goes on where he was gets other scenes than those he has labelled already.
        self._rng = np.random.default_rng([seed, len(self.folder.cards())])
        self._number = 0
        self.stage = self._next()
        self._actions: Mapping[str, Callable[[Message], Message]] = {
            "relation": self._change_relation,
            "assign": self._assign,
            "front": self._front,
            "next": self._turn,
            "ask": self._ask,
            "open": self._open,
            "put_down": self._put_down,
            "drop": self._drop,
            "check": self._check,
            "label": self._label,
            "delete": self._delete,
            "restore": self._restore,
            "records": lambda message: self._records(),
            "flip": self._flip,
            "learn": self._learn,
            "plan": self._plan,
        }

    def act(self, action: str, message: Message) -> Message:
        """Do what the page asks for; return what it needs to know.

        Raises:
            InputError: It cannot be done.
        """
        if action not in self._actions:
            raise InputError(f"unknown action '{action}'", found=action, choices=self._actions)
        with self._lock:
            return harmless(dict(self._actions[action](message)))

    def state(self) -> Message:
        """Return everything that the page shows."""
        with self._lock:
            return harmless({**self._records(), **self._staged()})

    def run_state(self) -> Message:
        """Return how far the command is that learns or plans."""
        run = self._runner.state()
        text = printable(run.text, "\n\t")
        if run.command == "tamp-learn":
            with self._lock:
                text = in_arguments(text, self.relation, self.folder)
        return {"command": run.command, "running": run.running, "code": run.code, "text": text}

    @property
    def uses(self) -> Uses:
        """Return the files of the relation that is demonstrated."""
        return Uses(self.relation.name, self.folder.path)

    def picture(self, name: str) -> bytes | None:
        """Render the thumbnail of a demonstration by its file's name; None where there is none."""
        with self._lock:
            card = next((one for one in self.folder.cards() if one.name == name), None)
        if card is None or card.scene is None:
            return None
        return thumbnail(card.scene, card.labels[0].arguments)

    # ---- what is shown

    def _records(self) -> Message:
        return records(self.relation, self.folder, self.uses)

    def _staged(self) -> dict[str, Any]:
        document = stage_document(self.stage, self._number)
        document["choices"] = [choices_of(one, self.stage.scene) for one in self.relation.arguments]
        return {"stage": document}

    def _turn_to(self, stage: Stage) -> Message:
        self._number += 1
        self.stage = stage
        return self._staged()

    def _next(self) -> Stage:
        if self._source.scene is None:
            return sample_stage(self.relation, self._rng)
        stage = open_stage(self._source.scene, self.relation, self._chosen)
        return stage if self._number == 0 else shuffled(stage, self._rng)

    # ---- what can be done

    def _change_relation(self, message: Message) -> Message:
        self._asked = None
        relation = parse_relation(read_word(message, "text"))
        path = self._source.folder(relation)
        folder = DemonstrationFolder(path, relation)
        ours = self._source.out is not None and relation.name != self.relation.name
        if ours and self.folder.cards():
            raise InputError(
                f"{path} has demonstrations of {self.relation.name}",
                remedy="Start tamp-demo with another --out, or without: then each relation has "
                "a folder of its own",
            )
        before, self.relation, self._chosen = self.relation, relation, {}
        try:
            stage = self._next()
        except InputError:
            self.relation = before
            raise
        self.folder = folder
        return {**self._turn_to(stage), **self._records()}

    def _assign(self, message: Message) -> Message:
        """Take another body or place of the scene as an argument; who had it gets the old one."""
        number, name = message.get("argument"), read_word(message, "name")
        if not isinstance(number, int) or not 0 <= number < len(self.relation.arguments):
            raise InputError("there is no such argument")
        choices = choices_of(self.relation.arguments[number], self.stage.scene)
        if name not in choices:
            raise InputError(f"'{name}' cannot be it", found=name, choices=choices)
        arguments = list(self.stage.arguments)
        if name in arguments:
            arguments[arguments.index(name)] = arguments[number]
        arguments[number] = name
        if self._source.scene is not None:
            names = [one.name for one in self.relation.arguments]
            self._chosen = dict(zip(names, arguments, strict=True))
        stage = self.stage.moved(self._poses(message))
        return self._turn_to(replace(stage, arguments=tuple(arguments)))

    def _front(self, message: Message) -> Message:
        """Make the side from which the page looks the front of what the arguments stand on."""
        stage = self.stage.moved(self._poses(message))
        return self._turn_to(stage.fronted(read_angle(message, "yaw")))

    def _turn(self, message: Message) -> Message:
        """Turn to another scene."""
        self._asked = None
        return self._turn_to(self._next())

    def _ask(self, message: Message) -> Message:
        """Turn to a scene whose label would tell most, by what was learned last."""
        if not self._asked:
            self._asked = telling_stages(self.uses, self._rng)
        return {**self._turn_to(self._asked.pop(0)), "asked": True}

    def _open(self, message: Message) -> Message:
        """Take up the scene of a demonstration again, to show a variant of it."""
        name = read_word(message, "name")
        card = next((one for one in self.folder.cards() if one.name == name), None)
        if card is None or card.scene is None:
            raise InputError(f"there is no demonstration '{name}'")
        arguments = card.labels[0].arguments
        if len(arguments) != len(self.relation.arguments):
            raise InputError(f"{name} names {len(arguments)} arguments")
        names = [one.name for one in self.relation.arguments]
        chosen = dict(zip(names, arguments, strict=True))
        return self._turn_to(open_stage(self.folder.path / name, self.relation, chosen))

    def _put_down(self, message: Message) -> Message:
        bodies = self.stage.posed(self._poses(message))
        name = self._movable(message)
        return {"T": flat(self._bench.put_down(name, bodies).matrix)}

    def _drop(self, message: Message) -> Message:
        bodies = self.stage.posed(self._poses(message))
        name = self._movable(message)
        return {"T": flat(self._bench.drop(name, bodies).matrix)}

    def _check(self, message: Message) -> Message:
        poses = self._poses(message)
        troubles = [one.text for one in self._troubles(poses)]
        return {"troubles": troubles, "opinion": self._opinion.of(self.uses, self.stage, poses)}

    def _label(self, message: Message) -> Message:
        """Write a demonstration, unless something is odd about it and nobody has said `anyway`."""
        poses, holds = self._poses(message), message.get("holds")
        if not isinstance(holds, bool):
            raise InputError("a label is true or false")
        stage = self.stage.moved(poses)
        label = Label(self.relation.name, stage.arguments, holds)
        if message.get("anyway") is not True:
            odd = [one.text for one in self._troubles(poses) if holds or one.kind != "hangs"]
            one = Demonstration(stage.scene, stage.arguments, holds)
            odd += contradicted(one, self.folder.demonstrations())
            if odd:
                return {"odd": odd}
        name = self.folder.add(stage.file(label))
        after = {}
        if message.get("next") is True:
            after = self._ask(message) if self._asked else self._turn(message)
        return {"saved": name, **self._records(), **after}

    def _delete(self, message: Message) -> Message:
        self.folder.remove(read_word(message, "name"))
        return self._records()

    def _restore(self, message: Message) -> Message:
        return {"restored": self.folder.restore(), **self._records()}

    def _flip(self, message: Message) -> Message:
        self.folder.flip(read_word(message, "name"))
        return self._records()

    def _learn(self, message: Message) -> Message:
        if not self.folder.demonstrations():
            raise InputError("nothing has been demonstrated yet", remedy="Label a scene: H or N")
        self._runner.start("tamp-learn", self.uses.learning)
        return self.run_state()

    def _plan(self, message: Message) -> Message:
        """Plan how the robot makes the relation true, from where the bodies are on the page."""
        stage, uses = self.stage.moved(self._poses(message)), self.uses
        if not uses.weights.is_file():
            raise InputError(f"{self.relation.name} has not been learned yet", remedy="Learn it")
        write_problem(uses, self.relation, stage, self._source.scene)
        self._runner.start("tamp-solve", uses.planning)
        return self.run_state()

    # ---- what is checked

    def _troubles(self, poses: Mapping[str, Pose]) -> list[Trouble]:
        return list(self._bench.troubles(self.stage.posed(poses), self.stage.movable))

    def _movable(self, message: Message) -> str:
        name = read_word(message, "body")
        if name not in self.stage.movable:
            raise InputError(f"'{name}' cannot be moved", found=name, choices=self.stage.movable)
        return name

    def _poses(self, message: Message) -> dict[str, Pose]:
        """Read the poses of the bodies that were moved, T_world_body, 16 numbers each."""
        if message.get("stage") != self._number:
            raise InputError("the page shows another scene", remedy="Load the page again")
        return read_poses(message, self.stage.movable)
