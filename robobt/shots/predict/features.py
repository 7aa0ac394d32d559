"""Feature vectors of a shot past the opponent nearest to its line.

All take scenes (n, 34) of :data:`~robobt.world.features.SHOT_SCENE`. In the formulas x
and b are the opponent's distances along and across the line, L is the target's
distance and v the opponent's speed towards the line.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from robobt.world.features import SCENE_HEAD, SHOT_SCENE
from robobt.world.geometry import FloatArray


def pair_features(scenes: ArrayLike) -> FloatArray:
    """Return Eq. 4, :data:`~robobt.world.features.SHOT`: angle [rad], L, opponent's distance, x, b [m].

    ``scenes`` (n, 34) are shots' scenes (:func:`robobt.shots.shot_inputs`); the result is (n, 5).
    """
    b, x, length, _ = motion_features(scenes).T
    return np.stack([np.arctan2(b, x), length, np.hypot(x, b), x, b], axis=-1)


def motion_features(scenes: ArrayLike) -> FloatArray:
    """Return b, x, L [m] and v [m/s]."""
    rows = np.asarray(scenes, dtype=np.float64)
    if rows.ndim != 2 or rows.shape[1] != SHOT_SCENE.size:
        raise ValueError(
            f"a shot's scene has {SHOT_SCENE.size} entries (shot_inputs), not shape {rows.shape}"
        )
    x, across, _, speed = rows[:, SCENE_HEAD : SCENE_HEAD + 4].T
    return np.stack([np.abs(across), x, rows[:, 0], -np.sign(across) * speed], axis=-1)
