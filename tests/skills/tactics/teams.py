"""Teams whose robots share out their tasks, on hand-made frames."""

from __future__ import annotations

from collections.abc import Sequence

from robobt.skills.plan import TeamPlan
from robobt.skills.store import TeamStore
from robobt.skills.tactics.agree import agree
from robobt.testing import frame, robot
from robobt.world import GameState, RobotState
from robobt.world.records import Mover, mover_records, movers
from tests.skills.refereed import OPEN

SIX = (
    robot(-4.3, 0.0, number=0),
    robot(-3.2, 0.3, number=1),
    robot(-3.2, -0.3, number=2),
    robot(-0.7, 0.0, number=3),
    robot(0.6, 1.4, number=4),
    robot(1.0, -1.5, number=5),
)
THEIRS = (
    robot(4.3, 0.0, number=0),
    robot(3.3, 0.2, number=1),
    robot(3.3, -0.2, number=2),
    robot(-2.5, 1.5, number=3),
    robot(-2.0, -1.5, number=4),
)


def records_of(*robots: RobotState) -> Sequence[Mover]:
    """Robots as compiled code sees them."""
    return mover_records(movers(robots))


class Agreement:
    """A team that agrees frame by frame; robot 0 keeps the goal."""

    def __init__(self) -> None:
        self.team = TeamStore()
        self.team.plan.players.update(range(1, 6))

    def at(
        self,
        time: float,
        ball: tuple[float, ...] = (0.0, 0.0),
        own: tuple[RobotState, ...] = SIX,
        theirs: tuple[RobotState, ...] = THEIRS,
        game: GameState = OPEN,
    ) -> TeamPlan:
        return agree(frame(own[0], ball, own[1:], theirs, time, game), self.team)
