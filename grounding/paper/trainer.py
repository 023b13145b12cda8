"""The paper's training (section III-D): the classifier, then the generator against discriminator
and classifier.

One run trains an ensemble: any number of pairs of a training set's size and a seed, each as if it
were trained alone. The classifier that is kept is the one of least loss on a tenth of its training
set that it is not trained on (of fewer than 100 examples none is spared, and the last is kept); the
generator is the last, as in the paper.
"""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import torch
from torch import Tensor
from torch.nn.functional import binary_cross_entropy_with_logits, softplus

from grounding.paper import networks
from grounding.paper.critic import critic_gradient
from grounding.paper.feature_table import FeatureTable
from grounding.paper.networks import NOISE, Batch, Ensemble, generate, score
from grounding.paper.random_streams import random_stream, stacked_draws
from grounding.paper.trainer_options import AHEAD, VALIDATION, TrainerOptions
from grounding.paper.trainer_state import load_state, save_state
from grounding.paper.training_scenes import TrainingScenes

SCHEMES = ("discriminator", "classifier", "both")
"""What teaches the generator: equation 3, equation 4, or both."""


@dataclass(eq=False)
class Trainer:
    """An ensemble in training; `run`, then `models`.

    Args:
        table: The training set.
        scene: Whether the networks see the surroundings.
        scheme: One of SCHEMES.
        sizes: How many of the examples each model sees.
        seeds: As many.
        args: How to train.
    """

    table: FeatureTable
    scene: bool
    scheme: str
    sizes: Sequence[int]
    seeds: Sequence[int]
    args: TrainerOptions = field(default_factory=TrainerOptions)

    def __post_init__(self) -> None:
        features = self.table.features
        seen = features, self.scene, self.args.attention
        self._scenes = TrainingScenes(self.table, self.scene, self.args)
        self._labels = torch.from_numpy(self.table.holds.astype(np.float32))
        start = self._randoms(0, 0)
        self.classifier = Ensemble(networks.classifier_shapes(*seen), start)
        self.critic = Ensemble(networks.critic_shapes(features), start)
        self.generator = Ensemble(networks.generator_shapes(*seen), start)
        self._best = self.classifier.flat.clone()
        self._mean = self.generator.flat.clone()
        self._least = torch.full((len(self.sizes),), torch.inf)
        self._done = torch.zeros(2, dtype=torch.int64)  # iterations of classifier and generator
        spared = [min(size // 10, VALIDATION) if size >= 100 else 0 for size in self.sizes]
        self._seen = [
            torch.arange(size - some) for size, some in zip(self.sizes, spared, strict=True)
        ]
        self._spared = [
            torch.arange(size - some, size) for size, some in zip(self.sizes, spared, strict=True)
        ]
        self._all = [torch.arange(size) for size in self.sizes]
        self._positive = [rows[self._labels[rows] > 0] for rows in self._all]

    def run(
        self, state: Path | None = None, progress: Callable[[str], None] = lambda _: None
    ) -> None:
        """Train to the end, from where `state` left off.

        Raises:
            InputError: The state is damaged or of another run.
        """
        threads = torch.get_num_threads()
        torch.set_num_threads(1)  # matrices this small only wait for each other
        try:
            if state is not None and state.is_file():
                load_state(state, self._tensors(), self._run())
                progress(f"going on after {int(self._done[0])} + {int(self._done[1])} iterations")
            for stage, (name, block) in enumerate(
                (("classifier", self._classify), ("generator", self._generate))
            ):
                self._stage(stage, name, block, state, progress)
        finally:
            torch.set_num_threads(threads)

    def take_classifiers(self, models: Sequence[Mapping[str, np.ndarray]]) -> None:
        """Take classifiers that are trained already, one a model, so that the generators alone are
        trained: of the same table, sizes, seeds and iterations they are those of this run.

        Args:
            models: Arrays as `models` yields them.
        """
        names = self.classifier.fixed
        for name, parts in zip(names, self.classifier.parts(self._best), strict=True):
            for part, arrays in zip(parts, models, strict=True):
                part.copy_(torch.from_numpy(arrays[f"classifier.{name}"]).view(part.shape))
        self.classifier.flat.copy_(self._best)
        self._done[0] = self.args.iterations

    def models(self) -> Iterator[dict[str, np.ndarray]]:
        """Yield classifier and generator of each model, as float32 arrays named like
        `classifier.main.0.weight`.
        """
        for index in range(len(self.sizes)):
            yield {
                f"{name}.{layer}": array
                for name, part in (("classifier", self.classifier), ("generator", self.generator))
                for layer, array in part.model(index).items()
            }

    def _stage(
        self,
        stage: int,
        name: str,
        block: Callable[[int, int], float],
        state: Path | None,
        progress: Callable[[str], None],
    ) -> None:
        start, first = time.perf_counter(), int(self._done[stage])
        for done in range(first, self.args.iterations, self.args.block):
            end = min(done + self.args.block, self.args.iterations)
            loss = block(done, end)
            self._done[stage] = end
            if end % self.args.save_every == 0 or end == self.args.iterations:
                speed = (end - first) / (time.perf_counter() - start)
                progress(
                    f"{name} {end} of {self.args.iterations}, {speed:.0f} iterations/s, "
                    f"loss {loss:.3f}"
                )
                if state is not None:
                    save_state(state, self._tensors(), self._run())
        if stage == 0:
            self.classifier.flat.copy_(self._best)
        elif self.args.mean_weights:
            self.generator.flat.copy_(self._mean)

    def _classify(self, start: int, end: int) -> float:
        """Train the classifier by equation 1, from one iteration to another; returns the mean loss
        of the last batches.
        """
        batches = self._draw(self._seen, 1, start, end - start)
        self._scenes.vary(self._randoms(6, start))
        total = torch.zeros(())
        for step, rows in enumerate(batches.unbind(1), start + 1):
            loss = binary_cross_entropy_with_logits(
                score(self.classifier.weights, self._scenes.batch(rows)),
                self._labels[rows],
                reduction="sum",
            )
            loss.backward()
            self.classifier.update(self.args.rate)
            total = loss.detach()
            if step % self.args.validate_every == 0 or step == self.args.iterations:
                self._validate()
        return float(total) / batches.shape[2] / len(self.sizes)

    @torch.no_grad()
    def _validate(self) -> None:
        """Keep the weights of each model whose validation loss has not been less."""
        for model, rows in enumerate(self._spared):
            loss = torch.tensor(-torch.inf)
            if len(rows):
                alone = {
                    name: tensor[model : model + 1]
                    for name, tensor in self.classifier.fixed.items()
                }
                scores = score(alone, self._scenes.as_they_are(rows[None]))[0]
                loss = binary_cross_entropy_with_logits(scores, self._labels[rows])
            if loss <= self._least[model]:
                self._least[model] = loss
                for best, now in zip(
                    self.classifier.parts(self._best), self.classifier.weights.values(), strict=True
                ):
                    best[model] = now[model]

    def _generate(self, start: int, end: int) -> float:
        """Train the generator by equations 2 to 4, from one iteration of the generator to another;
        returns the last mean loss.
        """
        taught = self.scheme != "classifier"
        steps = [taught * self.args.critic_steps_at(step) for step in range(start + 1, end + 1)]
        randoms = self._randoms(2, start)
        self._scenes.vary(self._randoms(5, start))
        scenes = self._draw(self._all, 3, start, sum(steps) + end - start)
        positive = self._draw(self._positive, 4, start, sum(steps))
        done, loss, batch = 0, torch.zeros(()), self.args.batch

        for count, last in zip(steps, range(end - start), strict=True):
            for first in range(done, done + count, AHEAD):
                some = min(AHEAD, done + count - first)
                rows = scenes[:, first : first + some].flatten(1)
                noise = stacked_draws(randoms, torch.randn, (rows.shape[1], NOISE))
                mixes = stacked_draws(randoms, torch.rand, (rows.shape[1], 1)).split(batch, dim=1)
                fakes = generate(self.generator.fixed, self._scenes.batch(rows), noise).split(
                    batch, dim=1
                )
                real = self._scenes.arguments(positive[:, first : first + some].flatten(1)).split(
                    batch, dim=1
                )
                for one, other, mix in zip(real, fakes, mixes, strict=True):
                    critic_gradient(self.critic, one, other, mix, self.args.penalty)
                    self.critic.update(self.args.rate)

            done += count
            rows = scenes[:, sum(steps) + last]
            loss = self._loss(
                self._scenes.batch(rows), stacked_draws(randoms, torch.randn, (batch, NOISE))
            )
            loss.backward()
            self.generator.update(self.args.rate)
            self._mean.lerp_(self.generator.flat, 1.0 - self.args.mean_weights)

        return float(loss.detach()) / batch / len(self.sizes)

    def _loss(self, batch: Batch, noise: Tensor) -> Tensor:
        """Compute the generator's loss: equation 3, equation 4, or their sum."""
        proposed = Batch(generate(self.generator.weights, batch, noise), batch.others, batch.share)
        if self.scheme == "both" and self.args.scaled_classifier:
            return self._scaled_loss(proposed)
        loss = torch.zeros(())
        if self.scheme != "classifier":
            loss = loss - score(self.critic.fixed, proposed).sum()
        if self.scheme != "discriminator":
            loss = loss + softplus(-score(self.classifier.fixed, proposed)).sum()
        return loss

    def _scaled_loss(self, proposed: Batch) -> Tensor:
        """Compute the sum of equations 3 and 4 with each model's classifier weighted such that its
        gradient at the proposals is as long as the critic's on average.
        """
        critic = -score(self.critic.fixed, proposed).sum(dim=1)
        classifier = softplus(-score(self.classifier.fixed, proposed)).sum(dim=1)
        lengths = [
            torch.autograd.grad(loss.sum(), proposed.arguments, retain_graph=True)[0]
            .norm(dim=2)
            .mean(dim=1)
            for loss in (critic, classifier)
        ]
        weight = lengths[0] / lengths[1].clamp_(min=1e-6)
        return (critic + weight.detach() * classifier).sum()

    def _draw(self, rows: Sequence[Tensor], stage: int, start: int, count: int) -> Tensor:
        """Draw batches of rows, shape (M, count, batch): each model's own, shuffled over and
        over.
        """
        drawn: list[Tensor] = []
        wanted = count * self.args.batch
        for size, seed, own in zip(self.sizes, self.seeds, rows, strict=True):
            random = random_stream(size, seed, stage, start)
            rounds = -(-wanted // len(own))
            shuffled = torch.rand((rounds, len(own)), generator=random).argsort(dim=1)
            drawn.append(own[shuffled.flatten()[:wanted]].view(count, self.args.batch))
        return torch.stack(drawn)

    def _randoms(self, stage: int, start: int) -> list[torch.Generator]:
        """Seed the random numbers of a block of iterations, a source a model."""
        return [
            random_stream(size, seed, stage, start)
            for size, seed in zip(self.sizes, self.seeds, strict=True)
        ]

    def _tensors(self) -> dict[str, Tensor]:
        parts = {"classifier": self.classifier, "critic": self.critic, "generator": self.generator}
        tensors = {
            f"{name}.{key}": getattr(part, key)
            for name, part in parts.items()
            for key in ("flat", "square")
        }
        kept = {"best": self._best, "least": self._least, "done": self._done, "mean": self._mean}
        return tensors | kept

    def _run(self) -> str:
        """Return the run's identity: what a state must agree in to go on from it."""
        digest = hashlib.blake2b(digest_size=16)
        for array in (self.table.arguments, self.table.others, self.table.holds):
            digest.update(np.ascontiguousarray(array).data)
        setting = (self.scene, self.scheme, tuple(self.sizes), tuple(self.seeds), self.args)
        return f"{digest.hexdigest()} {setting}"
