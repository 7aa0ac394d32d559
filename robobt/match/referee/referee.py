"""The referee: watches true frames, decides the game state and where the ball is to be put down.

Source of the rules: RoboCup SSL rules; command and stage numbers are those of
the league's referee protocol.
"""

from __future__ import annotations

from dataclasses import replace

from robobt.match.referee.events import Decision, EventKind, RefereeEvent
from robobt.match.referee.fouls import Fouls
from robobt.match.referee.positions import ball_placed, crowding, ready, spot_free, stop_violations
from robobt.match.referee.restarts import (
    DIRECT_FREE,
    PREPARE,
    Resumption,
    corner_kick,
    drop_ball,
    free_kick,
    goal_kick,
    kickoff,
)
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.touches import Touches
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import Point, distance
from robobt.world.rules import ball_out, exit_point, own_side, scorer
from robobt.world.state import Frame, RobotId

_SPOT_PATIENCE = 3.0
"""The ball is put down after this long even if a robot stands on the spot [s]."""


class Referee:
    """Follows the rules of a match in simulated time; the same frames give the same decisions.

    The team ``first_kickoff`` kicks off first; the other one does in the second half.

    Left out: cards and the robots they cost, time-outs, overtime, penalty
    shoot-outs, pushing and holding, and who places the ball (it is put down by
    hand). Teams keep their sides at half-time, because blue always defends -x.
    """

    def __init__(
        self, field: FieldGeometry, settings: RefereeSettings | None = None, first_kickoff: Team = Team.BLUE
    ) -> None:
        self.field = field
        self.settings = settings or RefereeSettings()
        self.first_kickoff = first_kickoff
        self.game = GameState(
            RefereeCommand.HALT, stage=Stage.NORMAL_FIRST_HALF_PRE, may_touch=False, placement=None
        )
        self._touches = Touches()
        self._fouls = Fouls(field, self.settings, self._touches)
        self._events: list[RefereeEvent] = []
        self._place: Point | None = None
        self._next = Resumption((0.0, 0.0))
        self._since: float | None = None
        self._half_began = 0.0
        self._ball_before: Point = (0.0, 0.0)
        self._reported: set[tuple[EventKind, RobotId]] = set()

    def update(self, frame: Frame) -> Decision:
        """Judge the next frame.

        ``frame`` shows what really is on the field, from blue's side; its time grows from call to call.
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

    def close(self) -> None:
        """Hold nothing that would have to be let go; see :class:`robobt.match.refereeing.MatchReferee`."""

    # What each state waits for.

    def _open(self, frame: Frame) -> None:
        self._half_began = frame.time
        self._ball_before = frame.ball.position
        if self.settings.opening == "force_start":
            self._next = Resumption(frame.ball.position)
            self._announce(replace(self.game, stage=Stage.NORMAL_FIRST_HALF), frame.time)
            self._play(frame, RefereeCommand.FORCE_START)
            return
        self._stop(frame, kickoff(self.first_kickoff))
        if ball_placed(frame, self._next.spot):
            self._prepare(frame, Restart.KICKOFF, self.first_kickoff)

    def _judge_halt(self, frame: Frame) -> None:
        if self.game.stage is not Stage.NORMAL_HALF_TIME or self._elapsed(frame) < self.settings.half_time:
            return
        self._half_began = frame.time
        self.game = replace(self.game, stage=Stage.NORMAL_SECOND_HALF_PRE)
        self._stop(frame, kickoff(self.first_kickoff.other))

    def _judge_stop(self, frame: Frame) -> None:
        elapsed, settings = self._elapsed(frame), self.settings
        if elapsed > settings.grace:
            for robot in stop_violations(frame, settings):
                self._record_once(frame, EventKind.BOT_TOO_FAST_IN_STOP, robot)
        if elapsed < settings.placement_delay:
            return
        spot, restart, team = self._next.spot, self._next.restart, self._next.team
        if not ball_placed(frame, spot):
            if spot_free(frame, spot) or elapsed > settings.placement_delay + _SPOT_PATIENCE:
                self._place = spot
            return
        if elapsed < settings.stop_time:
            return
        if restart is None or team is None:
            self._play(frame, RefereeCommand.FORCE_START)
        elif restart is Restart.FREE_KICK:
            self._allow(frame, DIRECT_FREE[team])
        else:
            self._prepare(frame, restart, team)

    def _judge_preparation(self, frame: Frame) -> None:
        if distance(frame.ball.position, self._next.spot) > self.settings.in_play_distance:
            self._repeat_restart(frame)
        elif self._elapsed(frame) >= self.settings.kickoff_wait or ready(
            frame, self.field, self.settings, self._next
        ):
            self._allow(frame, RefereeCommand.NORMAL_START)

    def _judge_restart(self, frame: Frame) -> None:
        team, last = self._next.team, self._touches.last
        if self._elapsed(frame) > self.settings.grace:
            for robot in crowding(frame, self.settings, team):
                self._record_once(frame, EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT, robot)
        if distance(frame.ball.position, self._next.spot) > self.settings.in_play_distance:
            if last is not None and last.team is not team:
                self._repeat_restart(frame)
                return
            self._play(frame, self.game.command, last)
            self._judge_play(frame)
        elif self._elapsed(frame) > self.settings.kick_timeout:
            self._play(frame, self.game.command)

    def _judge_play(self, frame: Frame) -> None:
        for foul in self._fouls.without_stop(frame):
            self._record(frame, foul.kind, foul.team, foul.robot)
        if ball_out(self.field, frame.ball.position):
            self._ball_left(frame)
            return
        for foul in self._fouls.with_stop(frame):
            self._record(frame, foul.kind, foul.team, foul.robot)
            if foul.resumption is not None:
                self._stop(frame, foul.resumption)
                return
        self._check_half(frame)

    # How the state changes.

    def _elapsed(self, frame: Frame) -> float:
        return frame.time - (frame.time if self._since is None else self._since)

    def _announce(self, game: GameState, time: float) -> None:
        self.game = game
        self._since = time
        self._reported.clear()

    def _stop(self, frame: Frame, resumption: Resumption) -> None:
        """STOP, and play goes on with ``resumption``."""
        self._next = resumption
        game = replace(
            self.game,
            command=RefereeCommand.STOP,
            restart=resumption.restart,
            restart_team=resumption.team,
            may_touch=False,
            placement=resumption.spot,
        )
        self._announce(game, frame.time)

    def _prepare(self, frame: Frame, restart: Restart, team: Team) -> None:
        """Let everybody take position for a kick-off or a penalty kick."""
        game = replace(
            self.game,
            command=PREPARE[restart, team],
            restart=restart,
            restart_team=team,
            may_touch=False,
            placement=self._next.spot,
        )
        self._announce(game, frame.time)

    def _allow(self, frame: Frame, command: RefereeCommand) -> None:
        """Let the restart be taken."""
        stage = _RUNNING.get(self.game.stage, self.game.stage)
        self._announce(replace(self.game, command=command, stage=stage, may_touch=True), frame.time)

    def _play(self, frame: Frame, command: RefereeCommand, kicker: RobotId | None = None) -> None:
        """Free the ball for both teams."""
        self._fouls.begin(frame, kicker, self._next.spot)
        game = replace(
            self.game, command=command, restart=None, restart_team=None, may_touch=True, placement=None
        )
        self._announce(game, frame.time)

    def _repeat_restart(self, frame: Frame) -> None:
        """Order the same restart again, because somebody moved the ball who may not."""
        self._stop(frame, self._next)

    def _record(self, frame: Frame, kind: EventKind, team: Team | None, robot: RobotId | None) -> None:
        self._events.append(RefereeEvent(frame.time, kind, team, robot, frame.ball.x, frame.ball.y))

    def _record_once(self, frame: Frame, kind: EventKind, robot: RobotId) -> None:
        if (kind, robot) not in self._reported:
            self._reported.add((kind, robot))
            self._record(frame, kind, robot.team, robot)

    # The ball out of the field, and the end of a half.

    def _ball_left(self, frame: Frame) -> None:
        ball, field, last = frame.ball.position, self.field, self._touches.last
        (x, y), over_goal_line = exit_point(field, self._ball_before, ball)
        if not over_goal_line:
            self._record(frame, EventKind.BALL_LEFT_FIELD_TOUCH_LINE, last.team if last else None, last)
            self._stop(frame, free_kick(field, last.team.other, x, y) if last else drop_ball(field, x, y))
            return
        defender = Team.BLUE if x < 0.0 else Team.YELLOW
        attacker = defender.other
        if scorer(field, self._ball_before, ball) is attacker:
            if self._fouls.annuls_goal(attacker, frame.time):
                self._record(frame, EventKind.INVALID_GOAL, attacker, last)
                self._stop(frame, goal_kick(field, defender, y))
            else:
                self._goal(frame, attacker)
            return
        where = self._touches.where
        from_own_half = where[0] * own_side(attacker) > 0.0
        if self.settings.aimless_kick and last is not None and last.team is attacker and from_own_half:
            self._record(frame, EventKind.AIMLESS_KICK, attacker, last)
            self._stop(frame, free_kick(field, defender, *where))
            return
        self._record(frame, EventKind.BALL_LEFT_FIELD_GOAL_LINE, last.team if last else None, last)
        if last is not None and last.team is defender:
            self._stop(frame, corner_kick(field, attacker, y))
        else:
            self._stop(frame, goal_kick(field, defender, y))

    def _goal(self, frame: Frame, team: Team) -> None:
        self._record(frame, EventKind.GOAL, team, self._touches.last)
        if team is Team.BLUE:
            self.game = replace(self.game, blue_score=self.game.blue_score + 1)
        else:
            self.game = replace(self.game, yellow_score=self.game.yellow_score + 1)
        self._stop(frame, kickoff(team.other))
        self._check_half(frame)

    def _check_half(self, frame: Frame) -> None:
        length = self.settings.half_length
        if length is None or frame.time - self._half_began < length:
            return
        first = self.game.stage in (Stage.NORMAL_FIRST_HALF_PRE, Stage.NORMAL_FIRST_HALF)
        game = replace(
            self.game,
            command=RefereeCommand.HALT,
            stage=Stage.NORMAL_HALF_TIME if first else Stage.POST_GAME,
            restart=None,
            restart_team=None,
            may_touch=False,
            placement=None,
        )
        self._announce(game, frame.time)


_RUNNING = {
    Stage.NORMAL_FIRST_HALF_PRE: Stage.NORMAL_FIRST_HALF,
    Stage.NORMAL_SECOND_HALF_PRE: Stage.NORMAL_SECOND_HALF,
}
