"""Options of the networks' training."""

from __future__ import annotations

from dataclasses import dataclass

AHEAD = 5
"""Batches that the generator proposes at once for the critic's steps, during which it does not
change.
"""

VALIDATION = 500
"""Examples of the validation split at most."""

HEADLINE_SCHEME = {"on": "discriminator"}
"""What teaches the generator unless it is said, by relation; `both` for all others. The published
example trains on `discriminator`, and on `on` `both` drives generators over the edge
(docs/paper-models.md).
"""


@dataclass(frozen=True)
class TrainerOptions:
    """The training options of the networks.

    Attributes:
        iterations: Of the classifier, and then of the generator.
        batch: Scenes a step and model.
        rate: RMSprop's learning rate.
        penalty: Weight of the critic's gradient penalty, the paper's lambda.
        critic_steps: Steps of the critic before each of the generator.
        critic_catches_up: The same for the first `first` steps of the generator, and for every
            `every`-th.
        validate_every: Iterations between looks at the validation split.
        save_every: Iterations between saved states, a multiple of `block`.
        mean_weights: Share of its running mean that the generator keeps a step, 0 for the last
            weights alone, as in the paper.
        scaled_classifier: Whether the classifier's gradient at a proposal is brought to the
            critic's mean length, where both teach; in the paper it is not.
        attention: Whether the surroundings are weighted by a softmax instead of pooled by their
            mean, as the paper's are.
        turned: Whether each scene is turned about the vertical, and half of them mirrored, anew
            for each block of iterations.
        scaled: Whether each is scaled anew for each block.
        residual: Whether argument 1 is shown unturned; the table of the trainer has it as it is.
        block: Iterations whose random numbers are drawn together, from seed, size, stage and the
            first of them.
    """

    iterations: int = 30_000
    batch: int = 16
    rate: float = 1e-3
    penalty: float = 10.0
    critic_steps: int = 5
    critic_catches_up: int = 100
    first: int = 24
    every: int = 500
    validate_every: int = 500
    save_every: int = 2000
    block: int = 500
    mean_weights: float = 0.0
    scaled_classifier: bool = False
    attention: bool = False
    turned: bool = False
    scaled: bool = False
    residual: bool = False

    def critic_steps_at(self, step: int) -> int:
        """Return the critic's steps before the generator's step of this number, from 1."""
        rarely = step <= self.first or step % self.every == 0
        return self.critic_catches_up if rarely else self.critic_steps
