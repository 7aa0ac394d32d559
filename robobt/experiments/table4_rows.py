"""The rows of Table 4: those the paper printed, and the figures of ours."""

from __future__ import annotations

from typing import TypedDict, cast


class PaperRow(TypedDict):
    """A printed row: means [s], variances [s^2] and goals of 25."""

    to_ball: float
    to_ball_s2: float
    shoot: float
    shoot_s2: float
    total: float
    total_s2: float
    goals: float


def _row(*figures: float) -> PaperRow:
    return cast(PaperRow, dict(zip(PaperRow.__annotations__, figures, strict=True)))


PAPER: dict[str, dict[str, PaperRow]] = {
    "1": {
        "ddpg": _row(2.9217, 0.0008, 0.2604, 0.0027, 3.1821, 0.0048, 23),
        "baseline": _row(3.4998, 0.0040, 0.2665, 0.0006, 3.7662, 0.0044, 25),
        "human": _row(3.483, 10.9620, 0.4032, 0.1709, 3.8862, 12.8650, 25),
    },
    "2": {
        "ddpg": _row(3.1262, 0.0196, 0.4031, 0.0012, 3.5294, 0.0196, 21),
        "baseline": _row(4.9846, 0.0141, 0.4713, 0.0057, 5.4560, 0.0193, 25),
        "human": _row(3.1691, 0.3725, 1.1236, 0.3481, 4.2927, 1.1300, 14),
    },
}
"""The paper's rows by trial."""


class Spread(TypedDict):
    """A time over the runs [s]: ``low`` and ``high`` are the 95 % interval of the mean."""

    n: int
    mean: float | None
    variance: float | None
    low: float | None
    high: float | None


class Share(TypedDict):
    """How many runs did it, with the 95 % Wilson interval of the rate."""

    count: int
    rate: float
    low: float
    high: float


class Row(TypedDict):
    """A combination's figures.

    ``optimum`` is the straight line's time for the approach at the speed and acceleration
    that it may use [s], ``optimum_ratio`` the mean approach over that.
    """

    approach: Spread
    pick_up: Spread
    to_ball: Spread
    shoot: Spread
    total: Spread
    goals: Share
    reached: Share
    shots: Share
    optimum: float
    optimum_ratio: float | None


class Comparison(TypedDict):
    """A paired t-test of ``n`` differences [s]."""

    mean: float
    variance: float
    t: float
    degrees: int
    p: float
    n: int


class Trial(TypedDict):
    """The table of one trial.

    ``best_hand_written`` is the hand-written combination that is first at the ball, and
    ``test`` compares the learned one's time to the ball with it.
    """

    paper: dict[str, PaperRow]
    rows: dict[str, Row]
    best_hand_written: str | None
    test: Comparison | None


class Table4(TypedDict):
    """All of Table 4, by trial."""

    runs: int
    preset: str
    realism: str | None
    trials: dict[str, Trial]
