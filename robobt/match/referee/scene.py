"""The input of the rules: a frame, the state of the game and their history."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from enum import Enum, auto
from math import hypot
from operator import attrgetter

from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.touches import Touches
from robobt.world.division import Division, division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.presence import without_absent
from robobt.world.rules import ball_out
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

_ROBOT_TOUCH_DISTANCE = 1.1 * 2.0 * ROBOT_RADIUS
"""Robots whose centres are no farther apart than this touch [m]. Source: AutoReferee."""

_place = attrgetter("x")


class PlayPhase(Enum):
    """The phases of play; each rule is checked in some of them."""

    HALT = auto()
    """Robots stand still: HALT and time-outs."""
    STOP = auto()
    PREPARE = auto()
    """Take positions for a kick-off or a penalty kick."""
    PLACEMENT = auto()
    """One team places the ball."""
    KICK = auto()
    """A kick-off or free kick may be taken."""
    PENALTY = auto()
    """A penalty kick may be taken or was taken; until the next command."""
    PLAY = auto()


class RefereeScene:
    """The sequence of frames, in world coordinates, seen from blue's side.

    Attributes:
        field: the field.
        settings: the settings of the checks.
        division: the division whose rules apply.
        frame: the present frame, without robots off the field.
        before: the last frame, None at the first frame.
        game: the state of the game that was decided on the last frame.
        phase: the phase of play.
        since: start of this phase [s].
        stopped: last time at which play was stopped or a placement began [s].
        penalty: the team of the present or last penalty kick.
        touches: present and past touches of the ball.
        out: whether the ball is out of the field.
        inside: the ball when it was last in the field.
    """

    def __init__(self, field: FieldGeometry, settings: RefereeSettings) -> None:
        self.field, self.settings = field, settings
        self.division: Division = division_of(field)
        self.touches = Touches()
        self.frame = Frame(0.0, field, BallState(0.0, 0.0))
        self.before: Frame | None = None
        self.game = GameState(RefereeCommand.HALT, may_touch=False)
        self.phase = PlayPhase.HALT
        self.since = 0.0
        self.stopped = 0.0
        self.penalty: Team | None = None
        self.out = False
        self.inside = BallState(0.0, 0.0)
        self._read: GameState | None = None
        self._state: object = None
        self._seen = False
        self._touching: list[tuple[RobotState, RobotState]] | None = None

    def update(self, frame: Frame, game: GameState) -> bool:
        """Take in the next frame; return whether a phase begins with it, even the same phase again."""
        self.before = self.frame if self._seen else None
        self._seen = True
        self.frame = frame = without_absent(frame, game)
        self.game = game
        self._touching = None
        self.touches.watch(frame)
        self.out = ball_out(self.field, frame.ball.position)
        if not self.out:
            self.inside = frame.ball
        if game is self._read:
            return False
        self._read = game
        state = (game.command, game.restart, game.restart_team)
        if state == self._state:
            return False
        self._state = state
        phase = self._phase_of(game)
        if phase is self.phase is PlayPhase.PENALTY:
            # The ball has moved, so the kick continues.
            return False
        if phase in _STOPPED_PHASES and self.phase not in _STOPPED_PHASES:
            self.stopped = frame.time
        self.touches.forget_heights()
        self.phase, self.since = phase, frame.time
        if phase is PlayPhase.PENALTY:
            self.penalty = game.restart_team
        return True

    @property
    def time(self) -> float:
        """The frame's time [s]."""
        return self.frame.time

    @property
    def elapsed(self) -> float:
        """How long the phase has lasted [s]."""
        return self.frame.time - self.since

    @property
    def touching(self) -> list[tuple[RobotState, RobotState]]:
        """The pairs of a blue and a yellow robot that touch; looked for once a frame."""
        if self._touching is None:
            self._touching = list(_close_pairs(self.frame, _ROBOT_TOUCH_DISTANCE))
        return self._touching

    def keeper(self, team: Team) -> RobotId:
        """Return a team's goalkeeper."""
        number = self.game.status(team).keeper
        return self.settings.keeper(team) if number is None else RobotId(team, number)

    def team(self, team: Team) -> tuple[RobotState, ...]:
        """Return a team's robots."""
        return self.frame.own if team is Team.BLUE else self.frame.opponents

    def robot(self, identity: RobotId) -> RobotState | None:
        """Return a robot, or None if it is not on the field."""
        for robot in self.team(identity.team):
            if robot.id == identity.number:
                return robot
        return None

    def pushed(self, team: Team, robot: RobotState) -> bool:
        """Return whether an opponent touches this robot and so may have pushed it there."""
        for other in self.team(team.other):
            dx, dy = other.x - robot.x, other.y - robot.y
            if dx * dx + dy * dy < _PUSHES_WITHIN * _PUSHES_WITHIN:
                return True
        return False

    def _phase_of(self, game: GameState) -> PlayPhase:
        if game.command in _PHASES:
            return _PHASES[game.command]
        if game.command is RefereeCommand.NORMAL_START and (
            game.restart is Restart.PENALTY or (game.restart is None and self.phase is PlayPhase.PENALTY)
        ):
            return PlayPhase.PENALTY
        return PlayPhase.PLAY if game.restart is None else PlayPhase.KICK


def _close_pairs(frame: Frame, reach: float) -> Iterator[tuple[RobotState, RobotState]]:
    """Find the pairs of a blue and a yellow robot with centres at most ``reach`` [m] apart."""
    yellows = sorted(frame.opponents, key=_place)
    places = [robot.x for robot in yellows]
    for blue in frame.own:
        x = blue.x
        for yellow in yellows[bisect_left(places, x - reach) :]:
            dx = yellow.x - x
            if dx > reach:
                break
            if hypot(dx, yellow.y - blue.y) <= reach:
                yield blue, yellow


_PUSHES_WITHIN = 0.19
"""Distance between centres within which a robot may push another [m]."""

_PHASES = {
    RefereeCommand.HALT: PlayPhase.HALT,
    RefereeCommand.TIMEOUT_BLUE: PlayPhase.HALT,
    RefereeCommand.TIMEOUT_YELLOW: PlayPhase.HALT,
    RefereeCommand.STOP: PlayPhase.STOP,
    RefereeCommand.PREPARE_KICKOFF_BLUE: PlayPhase.PREPARE,
    RefereeCommand.PREPARE_KICKOFF_YELLOW: PlayPhase.PREPARE,
    RefereeCommand.PREPARE_PENALTY_BLUE: PlayPhase.PREPARE,
    RefereeCommand.PREPARE_PENALTY_YELLOW: PlayPhase.PREPARE,
    RefereeCommand.BALL_PLACEMENT_BLUE: PlayPhase.PLACEMENT,
    RefereeCommand.BALL_PLACEMENT_YELLOW: PlayPhase.PLACEMENT,
}
_STOPPED_PHASES = frozenset({PlayPhase.STOP, PlayPhase.PLACEMENT, PlayPhase.HALT, PlayPhase.PREPARE})
