"""An automatic referee that is shown frames by hand, told from the side of one team."""

from __future__ import annotations

from dataclasses import replace

from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.settings import RefereeSettings
from robobt.world import DIVISION_B, BallState, FieldGeometry, Frame, GameState, RobotId, RobotState, Team
from robobt.world.game import RefereeCommand, Restart

PERIOD = 0.02
STOP = GameState(RefereeCommand.STOP, may_touch=False)
PLAY = GameState(RefereeCommand.FORCE_START)


class Watching:
    """Robots stand where they are put; the ball moves when told to; the game is as it is set."""

    def __init__(
        self, us: Team, field: FieldGeometry = DIVISION_B, game: GameState = PLAY, **settings: object
    ) -> None:
        self.us, self.them, self.field = us, us.other, field
        self.referee = AutomaticReferee(field, RefereeSettings(**settings))  # type: ignore[arg-type]
        self.game = game
        self.time = 0.0
        self.ball = BallState(0.0, 0.0)
        self.robots: dict[Team, dict[int, RobotState]] = {Team.BLUE: {}, Team.YELLOW: {}}
        self.touched: RobotId | None = None
        self.events: list[RefereeEvent] = []

    @property
    def kinds(self) -> list[EventKind]:
        return [event.kind for event in self.events]

    @property
    def last(self) -> RefereeEvent:
        return self.events[-1]

    def ours(self, number: int, x: float, y: float, **more: float) -> Watching:
        self.robots[self.us][number] = RobotState(number, x, y, **more)  # type: ignore[arg-type]
        return self

    def theirs(self, number: int, x: float, y: float, **more: float) -> Watching:
        self.robots[self.them][number] = RobotState(number, x, y, **more)  # type: ignore[arg-type]
        return self

    def touch(self, number: int, by: Team | None = None) -> Watching:
        self.touched = RobotId(by or self.us, number)
        return self

    def roll(
        self, x: float, y: float, vx: float = 0.0, vy: float = 0.0, z: float = 0.0, vz: float = 0.0
    ) -> Watching:
        """The ball is at (x, y), and so high, in the next frame."""
        self.ball = BallState(x, y, vx, vy, z, vz)
        return self.tick()

    def now(self, game: GameState) -> Watching:
        """The game is so from the next frame on; the placement as our side sees it."""
        self.game = game
        return self.tick()

    def kick_of(self, team: Team, restart: Restart = Restart.FREE_KICK) -> Watching:
        """A restart that may be taken."""
        command = RefereeCommand.NORMAL_START
        if restart is Restart.FREE_KICK:
            command = RefereeCommand[f"DIRECT_FREE_{team.name}"]
        return self.now(GameState(command, restart=restart, restart_team=team))

    def in_play(self) -> Watching:
        return self.now(replace(self.game, restart=None, restart_team=None, placement=None))

    def tick(self) -> Watching:
        own, opponents = (tuple(self.robots[team].values()) for team in (self.us, self.them))
        view = Frame(
            self.time, self.field, self.ball, own, opponents, self.us, PERIOD, self.game, self.touched
        ).seen_by(Team.BLUE)
        self.events += self.referee.watch(view, view.game)
        self.time += PERIOD
        return self

    def wait(self, seconds: float) -> Watching:
        for _ in range(round(seconds / PERIOD)):
            self.tick()
        return self

    def at(self, event: RefereeEvent) -> tuple[float, float]:
        """Return the event's place as our side sees it."""
        return (event.x, event.y) if self.us is Team.BLUE else (-event.x, -event.y)
