"""The people at a match under the official controller: they click, and place the ball.

Source of what the controller leaves to them: ssl-game-controller, ``engine/process_continue*.go``.
"""

from __future__ import annotations

import logging
from math import hypot

from robobt.config.wording import counted
from robobt.league.referee.setup import ball_position, command, stage
from robobt.league.wire.messages import Change
from robobt.match.referee.controller import HALT_TIME
from robobt.match.referee.positions import (
    NEAR_SPOT,
    PLACEMENT_AREA_GAP,
    STILL_BALL_SPEED,
    ball_placed,
    penalty_problems,
    spot_free,
)
from robobt.match.referee.restarts import free_kick_spot, penalty
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.stages import Stages
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.geometry import Point, distance
from robobt.world.presence import without_absent
from robobt.world.rules import ball_out, in_defense_area, own_side
from robobt.world.state import ROBOT_RADIUS, Frame

_NEAR_BALL = 0.54
"""No robot's centre may be nearer to the ball in STOP [m]."""


def ball_problems(field: FieldGeometry, frame: Frame, game: GameState) -> list[str]:
    """Return why the ball's place prevents play from continuing; empty if it is right."""
    ball, problems = frame.ball, []
    if ball.speed >= STILL_BALL_SPEED:
        problems.append("the ball rolls")
    if game.placement is not None and distance(ball.position, game.placement) > NEAR_SPOT:
        problems.append(f"the ball is {distance(ball.position, game.placement):.2f} m from its place")
    if any(in_defense_area(field, team, ball.x, ball.y, PLACEMENT_AREA_GAP) for team in Team):
        problems.append("the ball is too near to a defence area")
    if ball_out(field, ball.position):
        problems.append("the ball is out of the field")
    return problems


def waits_for(field: FieldGeometry, frame: Frame, game: GameState) -> list[str]:
    """Return why a STOP or the preparation of a kick-off or penalty kick does not continue, in words.

    The frame is a true one, seen from blue's side.
    """
    frame = without_absent(frame, game)
    robots = frame.robots()
    kicking = game.restart_team
    if game.restart is Restart.PENALTY and kicking is not None and game.command is not RefereeCommand.STOP:
        return list(penalty_problems(frame, field, game, penalty(field, kicking).spot, kicking))
    if game.restart is Restart.KICKOFF and game.command is not RefereeCommand.STOP:
        return [
            f"{robot} is not in its own half"
            for robot, state in robots.items()
            if state.x * own_side(robot.team) < ROBOT_RADIUS
        ]
    if game.command is not RefereeCommand.STOP:
        return []
    problems = ball_problems(field, frame, game)
    for robot, state in robots.items():
        gap = hypot(state.x - frame.ball.x, state.y - frame.ball.y)
        taker = game.restart is Restart.FREE_KICK and robot.team is game.restart_team
        if gap < _NEAR_BALL and not taker:
            problems.append(f"{robot} is {gap:.2f} m from the ball")
    for team in Team:
        most, there = game.status(team).max_robots, sum(robot.team is team for robot in robots)
        if most is not None and there > most:
            problems.append(f"{team.value} has {counted(there, 'robot')} and may have {most}")
    return problems


_log = logging.getLogger(__name__)

_SUBSTITUTION_TIME = 15.0
"""After this long a HALT for a substitution ends: after 20 s it would count as another one [s]."""

_TIMEOUT_TIME = 10.0
"""How long a time-out lasts [s]."""

_FORCE_START_DELAY = 5.0
"""A STOP after which nothing is to follow ends with a force start after this long [s]."""

_GIVEN_UP = 2.0
"""In a STOP that has lasted this long the controller will not ask robots to place the ball any more [s]."""

_PUT_DOWN_TIMEOUT = 5.0
"""The ball is put down after this long even if a robot stands on the spot [s]."""

_PUT_DOWN_SPEED = 0.15
"""A ball that is faster is not put down yet [m/s]."""

_PLACE_DIFFERENCE = 0.1
"""The controller's place is not the one of the restart from this distance on [m]."""

_REPORTED_STOP_TIME = 60.0
"""A stop longer than this is reported, with the reason for which the controller waits [s]."""

_BREAKS = frozenset(
    {Stage.NORMAL_HALF_TIME, Stage.EXTRA_TIME_BREAK, Stage.EXTRA_HALF_TIME, Stage.PENALTY_SHOOTOUT_BREAK}
)


class People:
    """The people at the field; frames are seen from blue's side, times are simulated.

    Args:
        field: where it is played.
        settings: which stages there are and how long the break between the halves lasts.
    """

    def __init__(self, field: FieldGeometry, settings: RefereeSettings) -> None:
        self._field, self._settings = field, settings
        self._state: tuple[RefereeCommand, Stage] | None = None
        self._since = 0.0
        self._told = False
        self._stages = Stages(settings)

    def clicks(self, frame: Frame, game: GameState) -> list[Change]:
        """Return the changes to send to the controller so that the match continues."""
        lasted = self._lasted(frame, game)
        if game.stage is Stage.POST_GAME:
            return []
        if game.stage in _BREAKS:
            over = lasted >= max(HALT_TIME, self._settings.half_time)
            return [stage(Stage(game.stage + 1))] if over else []
        if game.command is RefereeCommand.HALT:
            wait = _SUBSTITUTION_TIME if game.blue.substituting or game.yellow.substituting else HALT_TIME
            return [command("STOP")] if lasted >= wait else []
        if game.command in (RefereeCommand.TIMEOUT_BLUE, RefereeCommand.TIMEOUT_YELLOW):
            return [command("STOP")] if lasted >= _TIMEOUT_TIME else []
        if game.command is RefereeCommand.STOP:
            return self._clicks_in_stop(game, lasted)
        return []

    def _clicks_in_stop(self, game: GameState, lasted: float) -> list[Change]:
        stages = self._stages
        stages.stage = game.stage
        if stages.length is not None and game.stage_time is not None:
            stages.played = stages.length - game.stage_time
        over = stages.over((game.blue_score, game.yellow_score)) if game.stage in _PLAYED else None
        if over is not None and game.restart is Restart.PENALTY and not stages.shoot_out:
            # The penalty kick is still taken, but nothing continues automatically any more.
            return [command("PENALTY", game.restart_team)] if lasted >= _FORCE_START_DELAY else []
        if over is not None:
            return [stage(over)]
        spot = self._prepared(game)
        if (
            spot is not None
            and game.placement is not None
            and distance(game.placement, spot) > _PLACE_DIFFERENCE
        ):
            # A ball that left the field while a penalty was being given has moved its place, and the
            # controller waits for the ball to be there.
            return [ball_position(spot)]
        if game.upcoming is None and lasted >= _FORCE_START_DELAY:
            return [command("FORCE_START")]
        return []

    def puts_ball(self, frame: Frame, game: GameState) -> Point | None:
        """Return where the ball has to be put down by hand now, None to leave it."""
        spot = self._spot(frame, game)
        if spot is None or ball_placed(frame, spot):
            return None
        return spot if spot_free(frame, spot) or self._lasted(frame, game) > _PUT_DOWN_TIMEOUT else None

    def _lasted(self, frame: Frame, game: GameState) -> float:
        """Return for how long the present command and stage have been in force [s]."""
        state = (game.command, game.stage)
        if state != self._state:
            self._state, self._since, self._told = state, frame.time, False
            if state == (RefereeCommand.NORMAL_START, Stage.PENALTY_SHOOTOUT):
                self._stages.begin_attempt()
        lasted = frame.time - self._since
        if lasted > _REPORTED_STOP_TIME and not self._told and not game.in_play:
            self._told = True
            reasons = ", ".join(waits_for(self._field, frame, game)) or "nothing that can be seen"
            _log.warning("%s lasts for %.0f s: %s", game.command.name, lasted, reasons)
        return lasted

    def _prepared(self, game: GameState) -> Point | None:
        """Return where the ball belongs for a kick-off or penalty kick that is to come, None without one."""
        if game.restart is Restart.PENALTY and game.restart_team is not None and not game.may_touch:
            return penalty(self._field, game.restart_team).spot
        kickoff = game.restart is Restart.KICKOFF and not game.may_touch
        if kickoff or (game.command is RefereeCommand.HALT and game.upcoming in _KICKOFFS):
            return (0.0, 0.0)
        return None

    def _spot(self, frame: Frame, game: GameState) -> Point | None:
        prepared = self._prepared(game)
        if prepared is not None:
            return prepared
        wait = _GIVEN_UP if self._settings.placement == "robots" else self._settings.placement_delay
        given_up = game.command is RefereeCommand.STOP and self._lasted(frame, game) > wait
        if not given_up or frame.ball.speed > _PUT_DOWN_SPEED or not ball_problems(self._field, frame, game):
            return None
        return game.placement or free_kick_spot(self._field, *frame.ball.position)


_PLAYED = frozenset(
    {
        Stage.NORMAL_FIRST_HALF,
        Stage.NORMAL_SECOND_HALF,
        Stage.EXTRA_FIRST_HALF,
        Stage.EXTRA_SECOND_HALF,
        Stage.PENALTY_SHOOTOUT,
    }
)
_KICKOFFS = frozenset({RefereeCommand.PREPARE_KICKOFF_BLUE, RefereeCommand.PREPARE_KICKOFF_YELLOW})
