"""A network that sees every opponent of a shot's scene, and a shot as good as the worst of them leaves it."""

from __future__ import annotations

import torch
from torch import Tensor, nn

from robobt.world.features import SCENE_HEAD, SCENE_OPPONENTS, SHOT_SCENE

_INPUTS = 20
_SURE = 9.0
"""Log-odds at most: even an open goal is missed now and then."""


class SceneNetwork(nn.Module):
    """Probability of a goal from :data:`~robobt.world.features.SHOT_SCENE`.

    The same small network scores the shot past each opponent; the least score is
    the scene's. So the order of opponents does not matter, one more never makes a
    shot better, and an empty place changes nothing. Seen in a mirror along the line
    of the shot every opponent stands to its left, so that a scene and its mirror
    image get the same answer.

    Args:
        width: of its two hidden layers.
    """

    mean: Tensor
    scale: Tensor

    def __init__(self, width: int = 48) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(_INPUTS))
        self.register_buffer("scale", torch.ones(_INPUTS))
        self.layers = nn.Sequential(
            nn.Linear(_INPUTS, width), nn.SiLU(), nn.Linear(width, width), nn.SiLU(), nn.Linear(width, 1)
        )

    def inputs(self, scenes: Tensor) -> Tensor:
        """What is known about the shot and each opponent, (n, 6, 20), before it is scaled."""
        head = scenes[:, :SCENE_HEAD].unsqueeze(1)
        block = scenes[:, SCENE_HEAD:].reshape(-1, SCENE_OPPONENTS, 4)
        along, across = block[:, :, 0].clamp(-1.0, 9.0), block[:, :, 1].clamp(-4.0, 4.0)
        side = torch.sign(across + 1e-9)
        b = across.abs()
        speed, towards = block[:, :, 2], -side * block[:, :, 3]
        length = head[:, :, 0] + 0.0 * b
        # Lag of the ball: the way at its first speed.
        flight = along.clamp(min=0.0) / 6.5
        parts = [
            length,
            torch.cos(head[:, :, 1]) + 0.0 * b,
            side * torch.sin(head[:, :, 1]),
            head[:, :, 2] + 0.0 * b,
            side * head[:, :, 3],
            head[:, :, 3].abs() + 0.0 * b,
            head[:, :, 4] + 0.0 * b,
            side * head[:, :, 5],
            head[:, :, 6] + 0.0 * b,
            side * head[:, :, 7],
            side * head[:, :, 9],
            along,
            b,
            length - along,
            speed,
            towards,
            b / along.clamp(min=0.1),
            b - towards * flight,
            b - towards * flight - 2.0 * flight * flight,
            torch.sqrt(along * along + b * b),
        ]
        return torch.stack(parts, 2)

    def log_odds(self, scenes: Tensor) -> Tensor:
        """(n, 34) to (n,)."""
        scores: Tensor = self.layers((self.inputs(scenes) - self.mean) / self.scale).squeeze(2)
        # A place that is empty lies far behind the shooter.
        behind = torch.relu(-1.0 - scenes[:, SCENE_HEAD::4])
        least: Tensor = (scores + behind).clamp(max=_SURE).min(1)[0]
        return least

    def forward(self, scenes: Tensor) -> Tensor:
        """(n, 34) to (n, 1)."""
        return torch.sigmoid(self.log_odds(scenes)).unsqueeze(1)


assert SHOT_SCENE.size == SCENE_HEAD + 4 * SCENE_OPPONENTS
