"""The predictor that a learned rater asks."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

from robobt.models.file import ModelError
from robobt.world.features import ObservationSpec

if TYPE_CHECKING:
    from robobt.models.policy import Policy


@lru_cache(maxsize=32)
def shot_predictor(model: str, observation: ObservationSpec) -> Policy:
    """Load a shot predictor by a shipped model's name or a file's path, once per process."""
    from robobt.models.policy import load_policy

    policy = load_policy(model, observation=observation)
    if policy.card.kind != "shot_predictor":
        raise ModelError(f"{policy.path}: is a {policy.card.kind}, not a shot_predictor")
    return policy
