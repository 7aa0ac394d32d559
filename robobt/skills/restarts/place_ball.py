"""Bring the ball to where the referee wants it."""

from __future__ import annotations

from dataclasses import field
from math import atan2, copysign, cos, hypot, inf, radians, sin, sqrt

from robobt.motion.dribbling import holds_weakly, settle
from robobt.motion.path_planner import travel
from robobt.motion.pilot import command, drive, turn_rate
from robobt.skills.ball.dribble_to import SLIPPED
from robobt.skills.ball.fetch_ball import pull
from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.skills.restarts.keep_distance import way_out
from robobt.tree import Status
from robobt.world.game import RefereeCommand
from robobt.world.geometry import Point, direction, distance, wrap_angle
from robobt.world.rules import STOP_DISTANCE, has_ball
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_PLACING_SPEED = 1.0
"""Speed when driving backwards with the ball: 8 m take 10 s of the 30 s that the rules allow [m/s]."""

_WEAK_PLACING_SPEED = 0.85
"""That speed with a weak dribbler [m/s]: ER-Force's roller loses a ball that is pulled at 0.9 m/s."""

_STOPS_WITHIN = 1.0
"""Distance over which the robot can always stop with the ball [m]."""

_BALL_IN_MOUTH_DISTANCE = ROBOT_RADIUS
"""Distance from the robot's centre to the centre of a ball in its mouth [m]."""

_LET_GO_DISTANCE, _TAKE_AGAIN_DISTANCE = 0.06, 0.12
"""Distances to the spot at which the ball is released and taken again [m]; the rules ask for 0.15 m."""

_STANDSTILL_SPEED = 0.1
"""A ball or robot slower than this is at rest [m/s]."""

_RELEASING = 0.2
"""How long the robot stands with the dribbler off before it leaves a ball that the dribbler has spun [s]."""

_FREE_TURN_DISTANCE = 0.25
"""Distance from which a robot can turn without touching the ball [m]."""

_AT_WALL = 0.05
"""A ball this far behind a line is first pulled inwards, because a wall or a goal may be beside it [m]."""

_CLEAR_OF_WALL = 0.1
"""Distance inside the lines from which the ball counts as free [m]."""

_GOAL_MOUTH_DEPTH = 0.12
"""A ball in the goal mouth this close to the goal line is first pulled straight out past the posts [m]."""

_BESIDE_GOAL = 0.25
"""A ball behind the goal line this near to a goal counts as in the corner beside it [m]."""

_STUCK_AFTER, _STUCK_WITHIN = 1.5, 0.03
"""A ball that has not moved farther than this [m] for this long [s] beside a robot is out of its reach."""

_REACHES = 0.15
"""Distance from the ball at which the robot is beside it [m]."""

_CORNER_ANGLE = radians(25.0)
"""Angle to a board at which the edge of a front reaches a ball in a corner, which the hull keeps from its
middle [rad]."""

_CORNER_START, _CORNER_ASIDE = 0.3, 0.03
"""Where the robot starts towards that ball: its distance behind, and that of the ball from its middle line
[m]."""

_CORNER_SPEED, _CORNER_PRESS = 0.2, 0.05
"""Speeds towards that ball and towards the other board [m/s]."""

_CORNER_TIME = 1.8
"""How long it drives in before it backs out [s]."""

_AT_START = 0.03
"""Distance [m] and angle [rad] within which it is there."""

_PLACED_BALL_DISTANCE = STOP_DISTANCE + ROBOT_RADIUS + BALL_RADIUS + 0.1


@skill
class PlaceBall(DrivingSkill):
    """Pull the ball to the referee's spot, release it and back off.

    Never ends by itself: the referee decides when the placement is complete. FAILURE while the referee asks
    for no placement.

    Source of the order of steps: RoboCup SSL rules, chapter "Ball Placement".

    Args:
        limits: how to drive without the ball; None for the robot's own.
        speed_factor: factor on the top speed without the ball.
    """

    _there: bool = field(default=False, init=False)
    _let_go: bool = field(default=False, init=False)
    _released: float = field(default=0.0, init=False)
    _last_contact: float = field(default=-inf, init=False)
    _inwards: bool = field(default=False, init=False)
    _refuge: Point | None = field(default=None, init=False)
    _lies: Point = field(default=(inf, inf), init=False)
    _lies_since: float = field(default=0.0, init=False)
    _entered: float = field(default=-inf, init=False)

    def on_start(self) -> None:
        """Forget that the ball was placed."""
        self._there = self._let_go = self._inwards = False
        self._last_contact = -inf
        self._lies = (inf, inf)

    def on_running(self) -> Status:
        """Drive for one tick."""
        frame, me, ball, game = self.frame, self.me, self.ball, self.frame.game
        spot = game.placement
        if game.halted or game.command not in _ASKED:
            return self.fail("no ball placement")
        if spot is None:
            return self.run("the referee has named no spot")
        gap = distance(ball.position, spot)
        if gap > (_TAKE_AGAIN_DISTANCE if self._there else _LET_GO_DISTANCE):
            self._there = self._let_go = False
            self._refuge = None
            if self._out_of_reach():
                self._enter_corner()
                return self.run("reaching into the corner")
            goal = self._via(spot)
            outwards = direction(goal, ball.position)
            place = (
                goal[0] - _BALL_IN_MOUTH_DISTANCE * cos(outwards),
                goal[1] - _BALL_IN_MOUTH_DISTANCE * sin(outwards),
            )
            fastest = _WEAK_PLACING_SPEED if holds_weakly(me.limits) else _PLACING_SPEED
            self.store.command, doing = pull(
                frame,
                me,
                self._holds(),
                place,
                self.drive_limits,
                min(fastest, sqrt(2.0 * me.limits.holds_straight * _STOPS_WITHIN)),
                placing=True,
                sketch=self.draw,
            )
            return self.run(doing)
        self._there = True
        if not self._let_go and has_ball(me, ball) and hypot(me.vx, me.vy) > _STANDSTILL_SPEED:
            self.store.command = settle(me, frame.period)
            return self.run("stopping with it")
        if not self._let_go:
            self._let_go, self._released = True, frame.time
        if has_ball(me, ball) and frame.time - self._released < _RELEASING:
            return self.run("letting it come to rest")
        gap = distance(me.position, ball.position)
        if gap >= _PLACED_BALL_DISTANCE:
            return self.run("clear of it")
        if gap < _FREE_TURN_DISTANCE:
            # Drive straight back at once: a robot that turns or creeps drags the ball along.
            away = direction(ball.position, me.position)
            place = (ball.x + _PLACED_BALL_DISTANCE * cos(away), ball.y + _PLACED_BALL_DISTANCE * sin(away))
            self.store.command = drive(me, place, me.heading, me.limits, frame.period)
        else:
            # Keep one way out, because near a wall there are two of equal length.
            if self._refuge is None:
                self._refuge = way_out(frame, me, (ball.position, ball.position), _PLACED_BALL_DISTANCE * 1.1)
            self.store.command = travel(
                frame, me, self._refuge, me.heading, me.limits, avoid_ball=True, sketch=self.draw
            )
        return self.run("backing off")

    def _holds(self) -> bool:
        """Return whether the robot holds the ball, of which the sensor may be silent for a moment."""
        if self.me.ball_contact:
            self._last_contact = self.frame.time
        return has_ball(self.me, self.ball) and self.frame.time - self._last_contact < SLIPPED

    def _out_of_reach(self) -> bool:
        """Return whether the ball has been lying in a corner for long with the robot beside it."""
        frame, (x, y) = self.frame, self.ball.position
        if distance((x, y), self._lies) > _STUCK_WITHIN:
            self._lies, self._lies_since, self._entered = (x, y), frame.time, -inf
        elif distance((x, y), self.me.position) > _REACHES and frame.time - self._lies_since < _STUCK_AFTER:
            self._lies_since = frame.time
        in_corner = abs(x) > frame.field.half_length and abs(y) > frame.field.half_width
        return in_corner and frame.time - self._lies_since >= _STUCK_AFTER

    def _enter_corner(self) -> None:
        """Drive into the corner along one board, so that the edge of the front reaches the ball."""
        frame, me, (x, y) = self.frame, self.me, self.ball.position
        side = copysign(1.0, x * y)
        heading = atan2(copysign(sin(_CORNER_ANGLE), y), copysign(cos(_CORNER_ANGLE), x))
        c, s = cos(heading), sin(heading)
        aside = side * _CORNER_ASIDE
        start = (x - _CORNER_START * c + aside * s, y - _CORNER_START * s - aside * c)
        if distance(me.position, start) < _AT_START and abs(wrap_angle(me.heading - heading)) < _AT_START:
            self._entered = frame.time
        going = frame.time - self._entered
        if going > _CORNER_TIME + _CORNER_START / _CORNER_SPEED:
            self.store.command = travel(
                frame,
                me,
                start,
                heading,
                self.drive_limits,
                goalkeeper=True,
                placing=True,
                sketch=self.draw,
            )
            return
        ahead, left = _CORNER_SPEED, side * _CORNER_PRESS
        if going > _CORNER_TIME:
            ahead, left = -ahead, 0.0
        vx, vy = ahead * c - left * s, ahead * s + left * c
        omega = turn_rate(me, heading, me.limits, frame.period)
        self.store.command = command(me, vx, vy, omega, me.limits, frame.period)
        self.store.command.dribbler = True

    def _via(self, spot: Point) -> Point:
        """Return the ball's current target; from goals, walls and corners it first goes straight inwards."""
        lines, (x, y) = self.frame.field, self.ball.position
        slack = _CLEAR_OF_WALL if self._inwards else 0.0
        in_mouth = abs(y) < lines.goal_width / 2
        most_x = lines.half_length + (-_GOAL_MOUTH_DEPTH if in_mouth else _AT_WALL) - slack
        most_y = lines.half_width + _AT_WALL - slack
        self._inwards = abs(x) > most_x or abs(y) > most_y
        if not self._inwards:
            return spot
        inside_x, inside_y = lines.half_length - _CLEAR_OF_WALL, lines.half_width - _CLEAR_OF_WALL
        if in_mouth:
            # Pull it out of the goal, past the posts.
            inside_x -= _GOAL_MOUTH_DEPTH + _CLEAR_OF_WALL
            inside_y = lines.goal_width / 2 - ROBOT_RADIUS - _CLEAR_OF_WALL
        elif abs(x) > lines.half_length and abs(y) < lines.goal_width / 2 + _BESIDE_GOAL:
            # Pull it at an angle from beside the goal, whose wall leaves no room for the robot straight
            # behind the ball.
            return (copysign(inside_x, x), y + copysign(abs(x) - inside_x, y))
        return (min(inside_x, max(-inside_x, x)), min(inside_y, max(-inside_y, y)))


_ASKED = frozenset({RefereeCommand.BALL_PLACEMENT_BLUE, RefereeCommand.BALL_PLACEMENT_YELLOW})
