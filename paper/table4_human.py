"""Table 4's row that cannot be repeated: a person with a game controller."""

from __future__ import annotations

from collections.abc import Callable

from paper.table4_starts import SHOOTER
from robobt.live import LOOK, Live
from robobt.match import MatchLoop
from robobt.world import RobotId, Team

COUNTDOWN = 3.0
"""Before each run, in which nothing moves [s]."""


class HumanRuns:
    """Lets the steering viewer of the live page drive the robot of each run, from start to end.

    A run begins when the page is there and the countdown is over; its clock, start and ends are
    those of the other rows.
    """

    def __init__(self, live: Live, countdown: float = COUNTDOWN, look: float = LOOK) -> None:
        self._live, self._countdown, self._look = live, countdown, look

    def __call__(self, match: MatchLoop) -> Callable[[], bool]:
        """Show a match and count down; return what plays its next tick."""
        team, _, number = SHOOTER.partition(" ")
        self._live.begin(match).take(RobotId(Team(team), int(number)))
        self._live.count_down(match, self._countdown)

        def tick() -> bool:
            if self._live.tick(match):
                return True
            if match.outcome is None:
                # Fixed: the paper's person had 25 runs.
                self._live.forget_reset()
                return not self._live.ended
            self._live.linger(match, self._look)
            return False

        return tick
