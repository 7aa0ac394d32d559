"""Game states by name, and one skill driven on hand-made frames while the referee says one thing."""

from __future__ import annotations

from robobt.skills.store import TeamStore
from robobt.testing import frame
from robobt.tree import Behaviour, Status
from robobt.world import GameState, RefereeCommand, Restart, RobotState, Team
from robobt.world.geometry import Point
from tests.skills.fixed_world import Alone, moved

HALT = GameState(RefereeCommand.HALT, may_touch=False)
STOP = GameState(RefereeCommand.STOP, may_touch=False)
OPEN = GameState(RefereeCommand.NORMAL_START)


def stop_before(restart: Restart, team: Team, spot: Point) -> GameState:
    return GameState(RefereeCommand.STOP, restart=restart, restart_team=team, may_touch=False, placement=spot)


def free_kick(team: Team, spot: Point) -> GameState:
    command = RefereeCommand.DIRECT_FREE_BLUE if team is Team.BLUE else RefereeCommand.DIRECT_FREE_YELLOW
    return GameState(command, restart=Restart.FREE_KICK, restart_team=team, may_touch=True, placement=spot)


def kickoff(team: Team, may_touch: bool) -> GameState:
    prepare = (
        RefereeCommand.PREPARE_KICKOFF_BLUE if team is Team.BLUE else RefereeCommand.PREPARE_KICKOFF_YELLOW
    )
    return GameState(
        RefereeCommand.NORMAL_START if may_touch else prepare,
        restart=Restart.KICKOFF,
        restart_team=team,
        may_touch=may_touch,
        placement=(0.0, 0.0),
    )


def penalty(team: Team, spot: Point) -> GameState:
    prepare = (
        RefereeCommand.PREPARE_PENALTY_BLUE if team is Team.BLUE else RefereeCommand.PREPARE_PENALTY_YELLOW
    )
    return GameState(
        prepare,
        restart=Restart.PENALTY,
        restart_team=team,
        may_touch=False,
        placement=spot,
        penalty=team,
    )


def penalty_in_play(team: Team) -> GameState:
    return GameState(RefereeCommand.NORMAL_START, penalty=team)


def placement(spot: Point, team: Team) -> GameState:
    command = RefereeCommand[f"BALL_PLACEMENT_{team.name}"]
    return GameState(command, restart=Restart.BALL_PLACEMENT, restart_team=team, placement=spot)


class Drive:
    """One skill of robot ``me``, everything else at rest.

    Attributes:
        status: of the last tick.
        way: the robot after each tick, the start first.
    """

    def __init__(
        self,
        tree: Behaviour,
        me: RobotState,
        game: GameState,
        ball: tuple[float, ...],
        mates: tuple[RobotState, ...] = (),
        opponents: tuple[RobotState, ...] = (),
        team: TeamStore | None = None,
        seconds: float = 6.0,
        period: float = 1 / 60,
    ) -> None:
        alone = Alone(tree)
        if team is not None:
            alone.store.team = team
        self.way = [me]
        self.status = Status.INVALID
        for step in range(round(seconds / period)):
            view = frame(self.way[-1], ball, mates, opponents, step * period, game, period=period)
            self.status = alone.tick(view, me.id)
            self.way.append(moved(self.way[-1], alone.command, period))

    @property
    def end(self) -> RobotState:
        return self.way[-1]
