"""The rows of Table 4: those the paper printed, and the figures of ours."""

from __future__ import annotations

from typing import TypedDict, cast

from robobt.match import Rate


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


class Minimum(TypedDict):
    """The physical minimum of the runs' starts [s]: a straight line at top speed and strongest acceleration.

    ``to_ball`` ends with the ball in the mouth, from whatever side; ``to_kick`` with the ball in
    the mouth of a robot that faces the goal. The robot need not stop, and can turn on its way.
    """

    to_ball: float
    to_kick: float


class Row(TypedDict):
    """A combination's figures.

    ``ball_ratio`` and ``kick_ratio`` are mean times to the ball and to the kick over the means
    of their physical minimum, of the runs that got so far; None without one.
    ``paper_start`` is one run from the paper's own start.
    """

    approach: Spread
    pick_up: Spread
    to_ball: Spread
    shoot: Spread
    total: Spread
    goals: Rate
    reached: Rate
    shots: Rate
    ball_ratio: float | None
    kick_ratio: float | None
    paper_start: PaperStart


class PaperStart(TypedDict):
    """Times from the paper's own start [s]; None for what never happened."""

    to_ball: float | None
    total: float | None
    goal: bool


class Comparison(TypedDict):
    """Paired differences of ``n`` starts, learned less hand-written [s].

    ``low`` and ``high`` are the 95 % interval of the mean difference, ``effect`` is the mean over
    the differences' standard deviation; None where all differences are the same, or only one is known.
    """

    n: int
    mean: float
    low: float | None
    high: float | None
    effect: float | None


class Trial(TypedDict):
    """One trial at one set of limits.

    ``best_hand_written`` is the hand-written combination that kicks first, of those with the
    most goals. ``to_ball`` and ``to_kick`` compare the learned one with it.
    """

    minimum: Minimum | None
    rows: dict[str, Row]
    best_hand_written: str | None
    to_ball: Comparison | None
    to_kick: Comparison | None


class Table4(TypedDict):
    """All of Table 4: by limits, then by trial."""

    runs: int
    preset: str
    realism: str | None
    starts: str
    paper: dict[str, dict[str, PaperRow]]
    limits: dict[str, dict[str, Trial]]
