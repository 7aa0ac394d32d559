"""The paper's own protocol: the shots that Attack Main takes against a half-speed goalkeeper.

542 shots to train and 201 to test, in the two scenarios and with the clearance
tolerances of the published data, in its numbers: where that does not say which
tolerance it was, the middle one.
"""

from __future__ import annotations

from functools import lru_cache
from math import pi
from typing import NamedTuple

import numpy as np

from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.match.scenario.starts import Box
from robobt.shots.collect.plan import (
    CLOSE_RANGE,
    MID_RANGE,
    ROBOBULLS_SHOT_SPEED,
    Attempt,
    CollectionSettings,
    Section,
)

TRAIN, TEST = 542, 201
"""Shots to train and to test with."""

VALID = 179
"""Of those to train with, how many decide when to stop."""

SECTIONS: dict[str, Section] = {
    "near_left": ((1.6, 3.0), (0.7, 2.2)),
    "near_middle": ((1.6, 3.0), (-0.7, 0.7)),
    "near_right": ((1.6, 3.0), (-2.2, -0.7)),
    "far_left": ((0.1, 1.6), (0.7, 2.2)),
    "far_middle": ((0.1, 1.6), (-0.7, 0.7)),
    "far_right": ((0.1, 1.6), (-2.2, -0.7)),
}
"""Where the attacker that stays is put: x and y from, to [m]."""


class PaperShots(NamedTuple):
    """A number of shots of one scenario with one tolerance [m]."""

    scenario: str
    tolerance: float
    shots: int


TWICE, THRICE, FOUR_TIMES, PLUS = 0.243, 0.3645, 0.486, 0.1965
"""The paper's tolerances [m]: multiples of ball and robot radius, and that sum plus 75 mm."""

PARTS = (
    PaperShots("motion", TWICE, 43),
    PaperShots("motion", THRICE, 73),
    PaperShots("motion", FOUR_TIMES, 53),
    PaperShots("still", PLUS, 20),
    PaperShots("still", TWICE, 20),
    PaperShots("still", THRICE, 313),
    PaperShots("still", FOUR_TIMES, 20),
    PaperShots("motion", TWICE, 33),
    PaperShots("motion", THRICE, 33),
    PaperShots("motion", FOUR_TIMES, 35),
    PaperShots("still", TWICE, 100),
)
"""First those of the 542, then those of the 201."""


def paper_attempt(settings: CollectionSettings, trial: int) -> Attempt:
    """Return the set-up of a trial: the parts take turns."""
    kind, tolerance, _ = PARTS[trial % len(PARTS)]
    seed = trial_seed(settings.seed, trial)
    variant = "mid_range" if trial // len(PARTS) % 2 == 0 else "close_range"
    section: Section | None = None
    params: dict[str, object] = {
        "rater": {"name": "segment_clearance", "tolerance": tolerance},
        "shot_speed": ROBOBULLS_SHOT_SPEED,
    }
    base = _base(kind)
    blue = base.robots.blue[0]
    if kind == "motion":
        params["max_distance"] = MID_RANGE if variant == "mid_range" else CLOSE_RANGE
    else:
        variant = tuple(SECTIONS)[trial // len(PARTS) % len(SECTIONS)]
        section = x, y = SECTIONS[variant]
        # Pointing anywhere, so that the goalkeeper has taken its place when the shot comes.
        start = blue.start.model_copy(update={"position": Box(x=x, y=y), "heading": (-pi, pi)})
        blue = blue.model_copy(update={"start": start})
    blue = blue.model_copy(update={"params": params})
    robots = base.robots.model_copy(update={"blue": (blue,)})
    labels = {
        "scenario": kind,
        "variant": variant,
        "seed": settings.seed,
        "tolerance": tolerance,
        "goalkeeper_speed": 0.5,
        "goalkeeper": "half_speed",
    }
    return Attempt(base.model_copy(update={"robots": robots}), seed, labels, section)


def splits(success: list[int], seed: int) -> list[str]:
    """Return the ``early_stop_split`` of the 542 + 201 shots: valid ones drawn evenly from either kind."""
    rng = np.random.default_rng([seed, 3])
    names = ["train"] * TRAIN + ["test"] * TEST
    label = np.array(success[:TRAIN])
    goals = np.flatnonzero(label == 1)
    misses = np.flatnonzero(label == 0)
    share = round(VALID * len(goals) / TRAIN)
    for index in (*rng.permutation(goals)[:share], *rng.permutation(misses)[: VALID - share]):
        names[int(index)] = "valid"
    return names


@lru_cache(maxsize=2)
def _base(kind: str) -> Scenario:
    return load_scenario(f"attack_vs_goalkeeper_{kind}_half")
