"""What predictors make of a shot's scene: named vectors for one opponent at a time.

Each function is written once for numpy arrays and torch tensors, so that what is
exported computes what was trained. ``xp`` is the one module or the other; rows are
those of :data:`~robobt.world.features.SHOT_SCENE`. In the formulas x and b are the
opponent's distances along and across the line, L is the target's distance and v the
opponent's speed towards the line.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, TransformerMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from robobt.world.features import SCENE_HEAD, SHOT_SCENE
from robobt.world.geometry import FloatArray

Rows = Any
"""A numpy array or a torch tensor with leading axes."""

KICK_SPEED = 7.5
"""Speed of the recorded shots [m/s]: a constant input where the ball's speed is not recorded."""

_MM = 1000.0


def paper(xp: Any, head: Rows, block: Rows) -> Rows:
    """Eq. 4 in the author's units: angle [rad], L, opponent's distance, x and b [mm]."""
    length, x, b = head[..., 0], block[..., 0], abs(block[..., 1])
    far = (x * x + b * b) ** 0.5
    return xp.stack([_atan2(xp, b, x), length * _MM, far * _MM, x * _MM, b * _MM], -1)


def paper_velocity(xp: Any, head: Rows, block: Rows) -> Rows:
    """The same with v [mm/s]: what the paper leaves to do."""
    return _joined(xp, paper(xp, head, block), [towards_line(xp, block) * _MM])


def kiks(xp: Any, head: Rows, block: Rows) -> Rows:
    """Naito et al.: speed of the shot, opponent's distance and its angle to the shot [m/s, m, rad]."""
    x, b = block[..., 0], abs(block[..., 1])
    return xp.stack([head[..., 0] * 0.0 + KICK_SPEED, (x * x + b * b) ** 0.5, _atan2(xp, b, x)], -1)


def motion(xp: Any, head: Rows, block: Rows) -> Rows:
    """b, x, L [m] and v [m/s]."""
    return xp.stack([abs(block[..., 1]), block[..., 0], head[..., 0], towards_line(xp, block)], -1)


def towards_line(xp: Any, block: Rows) -> Rows:
    """An opponent's speed towards the line of the shot [m/s]."""
    return -xp.sign(block[..., 1]) * block[..., 3]


FEATURES: dict[str, Callable[[Any, Rows, Rows], Rows]] = {
    "paper": paper,
    "paper_velocity": paper_velocity,
    "kiks": kiks,
    "motion": motion,
}
"""Feature vectors by name: functions of the module, the scene's head (..., 10) and an opponent (..., 4)."""


class ShotFeatures(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """A named vector of the opponent nearest to the shot, from the scene of the shot.

    An entry that was not recorded (not-a-number) counts as its median over the training shots,
    0 where none of them has it.

    Args:
        name: one of :data:`FEATURES`.

    Attributes:
        typical_: (F,) those medians.
    """

    def __init__(self, name: str = "paper") -> None:
        self.name = name

    def fit(self, X: ArrayLike, y: ArrayLike | None = None) -> ShotFeatures:  # noqa: ARG002, N803
        """Check the input; there is nothing to learn.

        Raises:
            ValueError: X is not (n, 34) or holds an infinite value, or there is no such feature vector.
        """
        scenes = validate_data(self, X, ensure_all_finite="allow-nan")
        if scenes.shape[1] != SHOT_SCENE.size:
            raise ValueError(
                f"X has {scenes.shape[1]} columns, a shot's scene has {SHOT_SCENE.size} (shot_inputs)"
            )
        if self.name not in FEATURES:
            raise ValueError(f"no features are called {self.name!r}; there are {', '.join(FEATURES)}")
        vectors = self._vectors(np.asarray(scenes, dtype=np.float64))
        self.typical_ = np.array(
            [
                float(np.median(known)) if len(known := column[~np.isnan(column)]) else 0.0
                for column in vectors.T
            ]
        )
        return self

    def transform(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """(n, 34) scenes to (n, F)."""
        check_is_fitted(self)
        scenes = validate_data(self, X, reset=False, ensure_all_finite="allow-nan", dtype=np.float64)
        vectors = self._vectors(scenes)
        return np.where(np.isnan(vectors), self.typical_, vectors)

    def _vectors(self, scenes: FloatArray) -> FloatArray:
        head, block = scenes[:, :SCENE_HEAD], scenes[:, SCENE_HEAD : SCENE_HEAD + 4]
        return np.asarray(FEATURES[self.name](np, head, block), dtype=np.float64)

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.input_tags.allow_nan = True
        return tags


def _joined(xp: Any, rows: Rows, more: list[Rows]) -> Rows:
    return xp.concatenate([rows, xp.stack(more, -1)], -1)


def _atan2(xp: Any, y: Rows, x: Rows) -> Rows:
    return xp.arctan2(y, x)
