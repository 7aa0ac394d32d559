"""The referee: watches true frames, says the game state and where the ball is to be put down.

Source of the rules: RoboCup SSL rules; command and stage numbers are those of
the league's referee protocol.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import StrEnum
from math import hypot
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

from robobt.match.referee.touches import Touches
from robobt.match.restarts import corner_spot, free_kick_spot, goal_kick_spot, penalty_mark
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import (
    CARRY_DISTANCE,
    IN_PLAY_DISTANCE,
    PUSH_FACTOR,
    STOP_DISTANCE,
    STOP_SPEED,
    ball_out,
    exit_point,
    in_defense_area,
    own_side,
    scorer,
)
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState


class RefereeSettings(BaseModel):
    """What the referee looks at and how long things take. Times in simulated seconds.

    The distances and speeds are the rules' own; the pauses are short, because
    nobody has to carry the ball. A check whose value is None or false is off.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    opening: Literal["kickoff", "force_start"] = Field("kickoff", description="how the match begins")
    stop_time: float = Field(0.3, ge=0, le=60, description="shortest STOP before a restart [s]")
    placement_delay: float = Field(
        0.0, ge=0, le=60, description="from STOP until the ball lies at the restart's place [s]"
    )
    kickoff_wait: float = Field(
        2.0, ge=0, le=60, description="longest wait for positions at a kick-off or penalty [s]"
    )
    kick_timeout: float = Field(10.0, gt=0, le=60, description="a restart not taken by then is over [s]")
    in_play_distance: float = Field(
        IN_PLAY_DISTANCE, gt=0, le=0.5, description="the ball is in play after moving this far [m]"
    )
    double_touch: bool = Field(True, description="the kicker may not touch the ball twice")
    defense_areas: bool = Field(True, description="who may touch the ball in the defence areas")
    aimless_kick: bool = Field(True, description="no kick from the own half over the far goal line")
    max_dribble: float | None = Field(
        CARRY_DISTANCE, gt=0, le=50, description="longest way with the ball [m]"
    )
    max_ball_speed: float | None = Field(6.5, gt=0, le=50, description="fastest kick [m/s]")
    crash_speed: float | None = Field(1.5, gt=0, le=20, description="closing speed of a crash [m/s]")
    keeper_hold_time: float | None = Field(
        10.0, gt=0, le=600, description="longest stay of the ball in a defence area [s]"
    )
    no_progress_time: float | None = Field(10.0, gt=0, le=600, description="ball at rest for so long [s]")
    no_progress_distance: float = Field(0.1, gt=0, le=5, description="what counts as at rest [m]")
    stop_speed: float | None = Field(STOP_SPEED, gt=0, le=20, description="fastest robot in STOP [m/s]")
    stop_distance: float | None = Field(
        STOP_DISTANCE, gt=0, le=5, description="robot's hull to ball in STOP [m]"
    )
    grace: float = Field(2.0, ge=0, le=60, description="time to slow down and clear the ball [s]")
    half_length: float | None = Field(
        None, gt=0, le=36000, description="length of a half; none: one half without end [s]"
    )
    half_time: float = Field(0.0, ge=0, le=3600, description="HALT between the halves [s]")
    blue_keeper: int = Field(0, ge=0, le=31, description="number of blue's goalkeeper")
    yellow_keeper: int = Field(0, ge=0, le=31, description="number of yellow's goalkeeper")

    def keeper(self, team: Team) -> RobotId:
        """``team``'s goalkeeper."""
        return RobotId(team, self.blue_keeper if team is Team.BLUE else self.yellow_keeper)


class EventKind(StrEnum):
    """What a referee notes down."""

    GOAL = "goal"
    INVALID_GOAL = "invalid_goal"
    BALL_OUT = "ball_out"
    AIMLESS_KICK = "aimless_kick"
    DOUBLE_TOUCH = "double_touch"
    DRIBBLING = "dribbling"
    BALL_SPEED = "ball_speed"
    OWN_AREA_TOUCH = "own_area_touch"
    THEIR_AREA_TOUCH = "their_area_touch"
    KEEPER_HELD = "keeper_held"
    CRASH = "crash"
    NO_PROGRESS = "no_progress"
    STOP_SPEED = "stop_speed"
    STOP_DISTANCE = "stop_distance"
    INTERFERENCE = "interference"
    KICK_TIMEOUT = "kick_timeout"


@dataclass(slots=True, frozen=True)
class RefereeEvent:
    """Something the referee saw.

    Attributes:
        time: when [s].
        kind: what.
        team: who did it: the scorer of a goal, the offender of a foul; None when nobody did.
        robot: which robot, as far as known.
        x, y: where, in world coordinates [m].
    """

    time: float
    kind: EventKind
    team: Team | None
    robot: RobotId | None
    x: float
    y: float


@dataclass(slots=True)
class Decision:
    """The referee's word on one frame.

    Attributes:
        game: the game state from now on, in world coordinates.
        events: what happened in this frame.
        place_ball: where the ball has to be put down at rest right now, None to leave it [m].
    """

    game: GameState
    events: tuple[RefereeEvent, ...] = ()
    place_ball: Point | None = None


@dataclass(slots=True, frozen=True)
class _Resumption:
    """How play goes on after a STOP: a restart of ``team`` at ``spot``, or for both teams without one."""

    spot: Point
    restart: Restart | None = None
    team: Team | None = None


_SPOT_TOLERANCE = 0.05
"""A ball further from its spot than this is put down anew [m]."""

_SPOT_PATIENCE = 3.0
"""The ball is put down after this long even if a robot stands on the spot [s]."""

_REST_SPEED = 0.3
"""Robots slower than this stand ready [m/s]."""

_FOUL_MEMORY = 2.0
"""A foul that did not stop play annuls its team's goals for this long [s]."""

_EQUAL_SPEEDS = 0.3
"""Both robots are at fault in a crash when their speeds differ by less than this [m/s]."""

_SPEED_SLACK = 0.02
"""Measuring tolerance of speeds [m/s]."""

_PENALTY_GAP = 1.0
"""Everybody but kicker and keeper stays this far behind the ball at a penalty kick [m]."""


class Referee:
    """Follows the rules of a match in simulated time; the same frames give the same decisions.

    Args:
        field: dimensions.
        settings: checks and pauses.
        first_kickoff: who kicks off first; the other team does in the second half.

    Left out: cards and the robots they cost, time-outs, overtime, penalty
    shoot-outs, pushing and holding, and who places the ball (it is put down by
    hand). Teams keep their sides at half-time, because blue always defends -x.
    """

    def __init__(
        self,
        field: FieldGeometry,
        settings: RefereeSettings | None = None,
        first_kickoff: Team = Team.BLUE,
    ) -> None:
        self.field = field
        self.settings = settings or RefereeSettings()
        self.first_kickoff = first_kickoff
        self.game = GameState(
            RefereeCommand.HALT, stage=Stage.NORMAL_FIRST_HALF_PRE, may_touch=False, placement=None
        )
        self._touches = Touches()
        self._events: list[RefereeEvent] = []
        self._place: Point | None = None
        self._next = _Resumption((0.0, 0.0))
        self._since: float | None = None
        self._placed_at: float | None = None
        self._half_began = 0.0
        self._ball_before: Point = (0.0, 0.0)
        self._noted: set[tuple[EventKind, RobotId | None]] = set()
        self._fouls: dict[Team, float] = {}
        self._crashing: set[tuple[RobotId, RobotId]] = set()
        self._kicker: RobotId | None = None
        self._kicker_left = False
        self._too_fast = False
        self._rest_point: Point = (0.0, 0.0)
        self._rest_since = 0.0
        self._area_since: float | None = None

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame.

        Args:
            frame: what really is on the field, seen from blue's side; its time grows from call to call.

        Raises:
            ValueError: the frame is seen from yellow's side.
        """
        if frame.team is not Team.BLUE:
            raise ValueError("the referee looks from blue's side; pass World.truth() as it is")
        self._events, self._place = [], None
        self._touches.watch(frame)
        game = self.game
        if self._since is None:
            self._open(frame)
        elif game.in_play:
            self._judge_play(frame)
        elif game.halted:
            self._judge_halt(frame)
        elif game.stopped:
            self._judge_stop(frame)
        elif game.may_touch:
            self._judge_restart(frame)
        else:
            self._judge_preparation(frame)
        self._ball_before = frame.ball.position
        return Decision(self.game, tuple(self._events), self._place)

    # What each state waits for.

    def _open(self, frame: Frame) -> None:
        self._half_began = frame.time
        self._ball_before = frame.ball.position
        if self.settings.opening == "force_start":
            self._next = _Resumption(frame.ball.position)
            self._say(replace(self.game, stage=Stage.NORMAL_FIRST_HALF), frame.time)
            self._play(frame, RefereeCommand.FORCE_START)
            return
        kickoff = _Resumption((0.0, 0.0), Restart.KICKOFF, self.first_kickoff)
        self._stop(frame, kickoff)
        if self._ball_lies(frame):
            self._prepare(frame, Restart.KICKOFF, self.first_kickoff)

    def _judge_halt(self, frame: Frame) -> None:
        if self.game.stage is not Stage.NORMAL_HALF_TIME or self._elapsed(frame) < self.settings.half_time:
            return
        self._half_began = frame.time
        self.game = replace(self.game, stage=Stage.NORMAL_SECOND_HALF_PRE)
        self._stop(frame, _Resumption((0.0, 0.0), Restart.KICKOFF, self.first_kickoff.other))

    def _judge_stop(self, frame: Frame) -> None:
        self._check_stop_rules(frame)
        elapsed, settings = self._elapsed(frame), self.settings
        if elapsed < settings.placement_delay:
            return
        if not self._ball_lies(frame):
            if self._spot_free(frame) or elapsed > settings.placement_delay + _SPOT_PATIENCE:
                self._place = self._next.spot
            return
        if elapsed < settings.stop_time:
            return
        restart, team = self._next.restart, self._next.team
        if restart is None or team is None:
            self._play(frame, RefereeCommand.FORCE_START)
        elif restart is Restart.FREE_KICK:
            self._allow(frame, _DIRECT_FREE[team])
        else:
            self._prepare(frame, restart, team)

    def _judge_preparation(self, frame: Frame) -> None:
        if distance(frame.ball.position, self._next.spot) > self.settings.in_play_distance:
            self._interfere(frame)
        elif self._elapsed(frame) >= self.settings.kickoff_wait or self._ready(frame):
            self._allow(frame, RefereeCommand.NORMAL_START)

    def _judge_restart(self, frame: Frame) -> None:
        self._check_distances(frame)
        team = self._next.team
        last = self._touches.last
        if distance(frame.ball.position, self._next.spot) > self.settings.in_play_distance:
            if last is not None and last.team is not team:
                self._interfere(frame)
                return
            self._kicker, self._kicker_left = last, False
            self._play(frame, self.game.command)
            self._judge_play(frame)
        elif self._elapsed(frame) > self.settings.kick_timeout:
            self._note(frame, EventKind.KICK_TIMEOUT, team, None)
            self._play(frame, self.game.command)

    def _judge_play(self, frame: Frame) -> None:
        ball = frame.ball
        self._check_crashes(frame)
        self._check_ball_speed(frame)
        if ball_out(self.field, ball.position):
            self._ball_left(frame)
        elif not (
            self._check_areas(frame)
            or self._check_double_touch(frame)
            or self._check_dribbling(frame)
            or self._check_keeper_hold(frame)
            or self._check_progress(frame)
        ):
            self._check_half(frame)

    # How the state changes.

    def _elapsed(self, frame: Frame) -> float:
        return frame.time - (frame.time if self._since is None else self._since)

    def _say(self, game: GameState, time: float) -> None:
        self.game = game
        self._since = time
        self._noted.clear()

    def _stop(self, frame: Frame, resumption: _Resumption) -> None:
        """STOP, and play goes on with ``resumption``."""
        self._next = resumption
        self._kicker = None
        self._say(
            replace(
                self.game,
                command=RefereeCommand.STOP,
                restart=resumption.restart,
                restart_team=resumption.team,
                may_touch=False,
                placement=resumption.spot,
            ),
            frame.time,
        )

    def _prepare(self, frame: Frame, restart: Restart, team: Team) -> None:
        """Everybody takes position for a kick-off or a penalty kick."""
        commands = _PREPARE_KICKOFF if restart is Restart.KICKOFF else _PREPARE_PENALTY
        self._say(
            replace(
                self.game,
                command=commands[team],
                restart=restart,
                restart_team=team,
                may_touch=False,
                placement=self._next.spot,
            ),
            frame.time,
        )

    def _allow(self, frame: Frame, command: RefereeCommand) -> None:
        """The restart may be taken now."""
        self._say(
            replace(
                self.game,
                command=command,
                stage=_RUNNING.get(self.game.stage, self.game.stage),
                may_touch=True,
            ),
            frame.time,
        )

    def _play(self, frame: Frame, command: RefereeCommand) -> None:
        """The ball is free for both teams."""
        self._crashing.clear()
        self._rest_point, self._rest_since = frame.ball.position, frame.time
        self._area_since = None
        self._too_fast = False
        self._say(
            replace(
                self.game, command=command, restart=None, restart_team=None, may_touch=True, placement=None
            ),
            frame.time,
        )

    def _free_kick(self, frame: Frame, team: Team, x: float, y: float) -> None:
        self._stop(frame, _Resumption(free_kick_spot(self.field, x, y), Restart.FREE_KICK, team))

    def _interfere(self, frame: Frame) -> None:
        """Somebody moved the ball who may not: the same restart again."""
        last = self._touches.last
        self._note(frame, EventKind.INTERFERENCE, last.team if last else None, last)
        self._stop(frame, self._next)

    def _note(self, frame: Frame, kind: EventKind, team: Team | None, robot: RobotId | None) -> None:
        self._events.append(RefereeEvent(frame.time, kind, team, robot, frame.ball.x, frame.ball.y))

    def _note_once(self, frame: Frame, kind: EventKind, robot: RobotId) -> None:
        if (kind, robot) not in self._noted:
            self._noted.add((kind, robot))
            self._note(frame, kind, robot.team, robot)

    # The ball outside.

    def _ball_left(self, frame: Frame) -> None:
        ball, field, last = frame.ball, self.field, self._touches.last
        (x, y), over_goal_line = exit_point(field, self._ball_before, ball.position)
        if not over_goal_line:
            self._note(frame, EventKind.BALL_OUT, last.team if last else None, last)
            if last is None:
                self._stop(frame, _Resumption(free_kick_spot(field, x, y)))
            else:
                self._free_kick(frame, last.team.other, x, y)
            return
        defender = Team.BLUE if x < 0.0 else Team.YELLOW
        attacker = defender.other
        if scorer(field, self._ball_before, ball.position) is attacker:
            if frame.time - self._fouls.get(attacker, -_FOUL_MEMORY - 1.0) <= _FOUL_MEMORY:
                self._note(frame, EventKind.INVALID_GOAL, attacker, last)
                self._kick_in(frame, defender, goal_kick_spot(field, defender, y))
            else:
                self._goal(frame, attacker)
            return
        where = self._touches.where
        if (
            self.settings.aimless_kick
            and last is not None
            and last.team is attacker
            and where[0] * own_side(attacker) > 0.0
        ):
            self._note(frame, EventKind.AIMLESS_KICK, attacker, last)
            self._free_kick(frame, defender, *where)
            return
        self._note(frame, EventKind.BALL_OUT, last.team if last else None, last)
        if last is not None and last.team is defender:
            self._kick_in(frame, attacker, corner_spot(field, defender, y))
        else:
            self._kick_in(frame, defender, goal_kick_spot(field, defender, y))

    def _kick_in(self, frame: Frame, team: Team, spot: Point) -> None:
        self._stop(frame, _Resumption(spot, Restart.FREE_KICK, team))

    def _goal(self, frame: Frame, scorer: Team) -> None:
        self._note(frame, EventKind.GOAL, scorer, self._touches.last)
        if scorer is Team.BLUE:
            self.game = replace(self.game, blue_score=self.game.blue_score + 1)
        else:
            self.game = replace(self.game, yellow_score=self.game.yellow_score + 1)
        self._stop(frame, _Resumption((0.0, 0.0), Restart.KICKOFF, scorer.other))
        self._check_half(frame)

    # Checks in play; those that end it return whether they did.

    def _check_areas(self, frame: Frame) -> bool:
        if not self.settings.defense_areas:
            return False
        for toucher in self._touches.now:
            if toucher == self.settings.keeper(toucher.team):
                continue
            robot = _robot(frame, toucher)
            other = toucher.team.other
            if in_defense_area(self.field, toucher.team, robot.x, robot.y, -ROBOT_RADIUS):
                self._note(frame, EventKind.OWN_AREA_TOUCH, toucher.team, toucher)
                self._stop(frame, _Resumption(penalty_mark(self.field, other), Restart.PENALTY, other))
                return True
            if in_defense_area(self.field, other, robot.x, robot.y, ROBOT_RADIUS):
                self._fouls[toucher.team] = frame.time
                self._note_once(frame, EventKind.THEIR_AREA_TOUCH, toucher)
        return False

    def _check_double_touch(self, frame: Frame) -> bool:
        kicker, touches = self._kicker, self._touches
        if kicker is None or not self.settings.double_touch:
            return False
        if touches.last != kicker or any(robot != kicker for robot in touches.now):
            self._kicker = None
        elif kicker not in touches.now:
            self._kicker_left = True
        elif (
            self._kicker_left
            or distance(frame.ball.position, self._next.spot) > PUSH_FACTOR * self.settings.in_play_distance
        ):
            self._note(frame, EventKind.DOUBLE_TOUCH, kicker.team, kicker)
            self._free_kick(frame, kicker.team.other, *frame.ball.position)
            return True
        return False

    def _check_dribbling(self, frame: Frame) -> bool:
        most, carrier = self.settings.max_dribble, self._touches.carrier
        if most is None or carrier is None or self._touches.carried <= most:
            return False
        self._note(frame, EventKind.DRIBBLING, carrier.team, carrier)
        self._free_kick(frame, carrier.team.other, *frame.ball.position)
        return True

    def _check_ball_speed(self, frame: Frame) -> None:
        most = self.settings.max_ball_speed
        if most is None:
            return
        ball, last = frame.ball, self._touches.last
        fast = ball.vx * ball.vx + ball.vy * ball.vy > (most + _SPEED_SLACK) ** 2
        if fast and not self._too_fast and last is not None:
            self._fouls[last.team] = frame.time
            self._note(frame, EventKind.BALL_SPEED, last.team, last)
        self._too_fast = fast

    def _check_keeper_hold(self, frame: Frame) -> bool:
        limit = self.settings.keeper_hold_time
        if limit is None:
            return False
        ball = frame.ball
        for team in Team:
            if in_defense_area(self.field, team, ball.x, ball.y):
                if self._area_since is None:
                    self._area_since = frame.time
                elif frame.time - self._area_since > limit:
                    self._note(frame, EventKind.KEEPER_HELD, team, self.settings.keeper(team))
                    self._free_kick(frame, team.other, ball.x, ball.y)
                    return True
                return False
        self._area_since = None
        return False

    def _check_progress(self, frame: Frame) -> bool:
        limit = self.settings.no_progress_time
        if limit is None:
            return False
        ball = frame.ball.position
        if distance(ball, self._rest_point) > self.settings.no_progress_distance:
            self._rest_point, self._rest_since = ball, frame.time
        elif frame.time - self._rest_since > limit:
            self._note(frame, EventKind.NO_PROGRESS, None, None)
            self._stop(frame, _Resumption(free_kick_spot(self.field, *ball)))
            return True
        return False

    def _check_crashes(self, frame: Frame) -> None:
        limit = self.settings.crash_speed
        if limit is None:
            return
        reach = 2.0 * ROBOT_RADIUS + 0.01
        for blue in frame.own:
            for yellow in frame.opponents:
                dx, dy = yellow.x - blue.x, yellow.y - blue.y
                if abs(dx) < reach and abs(dy) < reach and 0.0 < (gap := hypot(dx, dy)) < reach:
                    closing = ((blue.vx - yellow.vx) * dx + (blue.vy - yellow.vy) * dy) / gap
                    if closing > limit:
                        self._crash(frame, blue, yellow)

    def _crash(self, frame: Frame, blue: RobotState, yellow: RobotState) -> None:
        pair = (RobotId(Team.BLUE, blue.id), RobotId(Team.YELLOW, yellow.id))
        if pair in self._crashing:
            return
        self._crashing.add(pair)
        lead = blue.speed - yellow.speed
        for robot, faster in ((pair[0], lead), (pair[1], -lead)):
            if faster > -_EQUAL_SPEEDS:
                self._fouls[robot.team] = frame.time
                self._note(frame, EventKind.CRASH, robot.team, robot)

    def _check_half(self, frame: Frame) -> None:
        length = self.settings.half_length
        if length is None or frame.time - self._half_began < length:
            return
        first = self.game.stage in (Stage.NORMAL_FIRST_HALF_PRE, Stage.NORMAL_FIRST_HALF)
        self._say(
            replace(
                self.game,
                command=RefereeCommand.HALT,
                stage=Stage.NORMAL_HALF_TIME if first else Stage.POST_GAME,
                restart=None,
                restart_team=None,
                may_touch=False,
                placement=None,
            ),
            frame.time,
        )

    # Checks while the ball is not in play.

    def _check_stop_rules(self, frame: Frame) -> None:
        if self._elapsed(frame) <= self.settings.grace:
            return
        most, least, ball = self.settings.stop_speed, self.settings.stop_distance, frame.ball
        for identity, robot in _everybody(frame):
            if most is not None and robot.speed > most + _SPEED_SLACK:
                self._note_once(frame, EventKind.STOP_SPEED, identity)
            if least is not None and _hull_gap(robot, ball) < least:
                self._note_once(frame, EventKind.STOP_DISTANCE, identity)

    def _check_distances(self, frame: Frame) -> None:
        """Opponents keep clear of the ball while a restart is taken."""
        least = self.settings.stop_distance
        if least is None or self._elapsed(frame) <= self.settings.grace:
            return
        for identity, robot in _everybody(frame):
            if identity.team is not self._next.team and _hull_gap(robot, frame.ball) < least:
                self._note_once(frame, EventKind.STOP_DISTANCE, identity)

    def _ball_lies(self, frame: Frame) -> bool:
        return distance(frame.ball.position, self._next.spot) <= _SPOT_TOLERANCE and frame.ball.speed < 0.05

    def _spot_free(self, frame: Frame) -> bool:
        x, y = self._next.spot
        clear = ROBOT_RADIUS + BALL_RADIUS + 0.02
        return all(hypot(robot.x - x, robot.y - y) > clear for _, robot in _everybody(frame))

    def _ready(self, frame: Frame) -> bool:
        """Whether everybody stands where the rules want them at a kick-off or penalty."""
        kickoff = self._next.restart is Restart.KICKOFF
        team, field = self._next.team, self.field
        if team is None:
            return True
        kickers = 0
        for identity, robot in _everybody(frame):
            if robot.speed > _REST_SPEED:
                return False
            if kickoff:
                fair = robot.x * own_side(identity.team) > 0.0
                if hypot(robot.x, robot.y) < field.center_radius + ROBOT_RADIUS:
                    fair = identity.team is team
                    kickers += 1
            elif identity == self.settings.keeper(team.other):
                fair = abs(abs(robot.x) - field.half_length) <= ROBOT_RADIUS
            else:
                behind = (self._next.spot[0] - robot.x) * -own_side(team)
                fair = behind >= _PENALTY_GAP
                if not fair and identity.team is team and behind > 0.0:
                    fair = True
                    kickers += 1
            if not fair or kickers > 1:
                return False
        return True


def _everybody(frame: Frame) -> list[tuple[RobotId, RobotState]]:
    return [(RobotId(frame.team, robot.id), robot) for robot in frame.own] + [
        (RobotId(frame.team.other, robot.id), robot) for robot in frame.opponents
    ]


def _robot(frame: Frame, identity: RobotId) -> RobotState:
    robots = frame.own if identity.team is frame.team else frame.opponents
    return next(robot for robot in robots if robot.id == identity.number)


def _hull_gap(robot: RobotState, ball: BallState) -> float:
    return hypot(robot.x - ball.x, robot.y - ball.y) - ROBOT_RADIUS


_DIRECT_FREE = {Team.BLUE: RefereeCommand.DIRECT_FREE_BLUE, Team.YELLOW: RefereeCommand.DIRECT_FREE_YELLOW}
_PREPARE_KICKOFF = {
    Team.BLUE: RefereeCommand.PREPARE_KICKOFF_BLUE,
    Team.YELLOW: RefereeCommand.PREPARE_KICKOFF_YELLOW,
}
_PREPARE_PENALTY = {
    Team.BLUE: RefereeCommand.PREPARE_PENALTY_BLUE,
    Team.YELLOW: RefereeCommand.PREPARE_PENALTY_YELLOW,
}
_RUNNING = {
    Stage.NORMAL_FIRST_HALF_PRE: Stage.NORMAL_FIRST_HALF,
    Stage.NORMAL_SECOND_HALF_PRE: Stage.NORMAL_SECOND_HALF,
}
