import torch

from grounding.paper.critic import critic_gradient
from grounding.paper.networks import Batch, Ensemble, critic_shapes, score

MODELS, SCENES, FEATURES, PENALTY = 3, 16, 19, 10.0


def test_the_gradient_by_hand_is_that_of_automatic_differentiation():
    critic = Ensemble(
        critic_shapes(FEATURES), [torch.Generator().manual_seed(seed) for seed in range(MODELS)]
    )
    random = torch.Generator().manual_seed(9)
    for name, tensor in critic.fixed.items():
        if name.endswith("bias"):
            tensor.normal_(generator=random)
    real, fake = torch.randn((2, MODELS, SCENES, 2 * FEATURES), generator=random)
    mix = torch.rand((MODELS, SCENES, 1), generator=random)

    def scores(arguments):
        return score(critic.weights, Batch(arguments, torch.zeros(0), torch.zeros(0)))

    between = (mix * real + (1 - mix) * fake).requires_grad_()
    (slope,) = torch.autograd.grad(scores(between).sum(), between, create_graph=True)
    loss = scores(fake) - scores(real) + PENALTY * (slope.norm(dim=2) - 1) ** 2
    expected = torch.autograd.grad(
        loss.mean(dim=1).sum(), list(critic.weights.values()), allow_unused=True
    )

    critic.gradient.zero_()
    critic_gradient(critic, real, fake, mix, PENALTY)
    found = critic.parts(critic.gradient)
    assert len(found) == 8
    for one, other in zip(expected, found, strict=True):
        torch.testing.assert_close(
            other, torch.zeros_like(other) if one is None else one, atol=1e-4, rtol=1e-4
        )
