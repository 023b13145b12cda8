"""One step of the discriminator: Wasserstein's loss with gradient penalty (equation 2),
differentiated by hand.

Nine tenths of the training time are steps of the critic. It is piecewise linear, so its gradient
with respect to the input is a product of its matrices with the ReLUs' masks, and the penalty's
gradient with respect to the matrices is one more pass through them; the masks do not move. That
takes a third of the time of automatic differentiation twice over.
"""

from __future__ import annotations

import torch
from torch import Tensor

from grounding.paper.networks import Ensemble


@torch.no_grad()
def critic_gradient(
    critic: Ensemble, real: Tensor, fake: Tensor, mix: Tensor, penalty: float
) -> None:
    """Add the gradient of the mean loss to the critic's.

    With h the activations, m the masks, u the derivative of each score with respect to a layer's
    output: the loss of real and fake scenes has the derivative h^T u of a matrix, their rows
    weighted by -1/B and 1/B. At the points x^ between them, g = u_0 W_0^T is the input's gradient,
    and p = penalty * mean (|g| - 1)^2 has dp/dW_k = v_k^T u_k, where v_0 = dp/dg and v_(k+1) = m_k
    v_k W_k: the same products with v in place of h.

    Args:
        critic: The discriminators; only `main` layers.
        real: Arguments' features of positive scenes, shape (M, B, 2 f).
        fake: Of generated ones, shape (M, B, 2 f).
        mix: Where between them the penalty is taken, in [0, 1), shape (M, B, 1).
        penalty: The paper's lambda.
    """
    scenes = real.shape[1]
    weights = [critic.weights[name] for name in critic.weights if name.endswith("weight")]
    biases = [critic.weights[name] for name in critic.weights if name.endswith("bias")]
    last = len(weights) - 1
    inputs = [torch.cat([real, fake, torch.lerp(fake, real, mix)], dim=1)]
    masks: list[Tensor] = []
    for weight, bias in zip(weights[:last], biases[:last], strict=True):
        hidden = torch.baddbmm(bias, inputs[-1], weight).relu_()
        inputs.append(hidden)
        masks.append(hidden.sign())

    slopes = [_weighted(scenes, inputs[0])]
    for weight, mask in zip(weights[:0:-1], masks[::-1], strict=True):
        slopes.insert(0, torch.bmm(slopes[0], weight.transpose(1, 2)).mul_(mask))
    gradient = torch.bmm(slopes[0][:, 2 * scenes :], weights[0].transpose(1, 2))
    norm = torch.linalg.vector_norm(gradient, dim=2, keepdim=True)
    change = gradient.mul_((1 - 1 / norm.clamp_(min=1e-12)).mul_(2 * penalty / scenes))

    for number, (weight, bias) in enumerate(zip(weights, biases, strict=True)):
        slope, values = slopes[number], inputs[number]
        values[:, 2 * scenes :] = change
        _grad(weight).baddbmm_(values.transpose(1, 2), slope)
        _grad(bias).add_(slope[:, : 2 * scenes].sum(dim=1, keepdim=True))
        if number < last:
            change = torch.bmm(change, weight).mul_(masks[number][:, 2 * scenes :])


def _weighted(scenes: int, like: Tensor) -> Tensor:
    """Weight the last layer's u: a row counts -1/B when real, 1/B when fake, and 1 in between;
    shape (M, 3 B, 1).
    """
    weights = torch.tensor([-1 / scenes, 1 / scenes, 1.0]).repeat_interleave(scenes)
    return weights.view(1, -1, 1).expand(len(like), -1, 1)


def _grad(tensor: Tensor) -> Tensor:
    if tensor.grad is None:
        raise ValueError("the critic's weights are frozen")
    return tensor.grad
