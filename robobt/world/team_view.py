"""The observation of a robot in a team: itself, the ball, both goals and nearby robots."""

from __future__ import annotations

import re
from collections.abc import Sequence
from math import copysign, cos, hypot, inf, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from robobt.world.compiled import compilable, compiled, compiled_merged
from robobt.world.geometry import FloatArray, Point
from robobt.world.observation import Group, ObservationSpec, entries, kinematics, motion, record_of, turned
from robobt.world.records import BALL as BALL_RECORD
from robobt.world.records import ROBOT, Ball, Robot
from robobt.world.scoring import FAR_OFF, KICK_SPEED
from robobt.world.state import Frame, RobotState

AWAY = 5.0
"""An empty place shows a resting robot this far behind [m]."""

BALL_INDEX = 7
"""Index of the ball's place."""

_ITSELF = (
    *entries("vx vy", "m/s", "speed", "max_speed"),
    *entries("omega", "rad/s", "turn", "max_turn"),
    *entries("x", "m", "far", 3.0),
    *entries("y", "m", "far", 2.0),
    *entries("cos_heading sin_heading", most=1.0),
    *entries("ball_x", "m", "away", 2.0),
    *entries("ball_y", "m", "away", 1.5),
    *entries("ball_vx ball_vy", "m/s", "ball_speed", 3.0),
    *(
        entry
        for place in ("left_post", "right_post", "own_goal")
        for entry in (*entries(f"{place}_x", "m", "goal", 4.0), *entries(f"{place}_y", "m", "goal", 2.0))
    ),
    *entries("aim", "m", FAR_OFF, 0.3),
    *entries("lane", "m", FAR_OFF / 2, 0.2),
)
"""What it sees of itself, the ball and both goals."""

_ITSELF_FIELDS = record_of(_ITSELF)
_OWN, _EACH = len(_ITSELF), 4
_RESTART_ENDINGS = ("", "_restarts", "_restarts_double_touch")
"""Suffixes of the name: no restarts, the team of a restart, or also the robot that may not touch the ball."""

_TEAM_VIEW_NAME = re.compile(r"team_view_(\d|10)_(\d|1[01])(|_restarts|_restarts_double_touch)")
_ME = np.zeros(1, dtype=np.int64)


class Places(NamedTuple):
    """Number of places for team-mates and opponents, and number of entries on restarts."""

    mates: int
    opponents: int
    told: int


def team_view(mates: int, opponents: int, told: int = 0) -> ObservationSpec:
    """Return the observation with this number of places for team-mates and opponents, the nearest first.

    Velocities are relative to the field. Velocities and positions are in the robot's frame; only ``x``, ``y``
    and the heading are in the frame of the team, which attacks towards +x. ``aim`` is where a kick would
    cross the goal line, from its middle, at most 1 m either way; ``lane`` is how far to the left of that shot
    the nearest opponent is, at most 0.5 m either way, 0.5 without an opponent on the way.

    ``told`` is the number of entries on the league's restarts that follow, 0, 1 or 2: ``restart`` is 1 if the
    own team may play the ball, -1 if the others may, 0 in play; ``barred`` is 1 if the robot took the last
    restart and may not touch the ball before another robot has, else 0.
    """
    others = [f"mate_{k}" for k in range(mates)] + [f"opponent_{k}" for k in range(opponents)]
    vector = (
        *_ITSELF,
        *(
            entry
            for who in others
            for entry in (
                *entries(f"{who}_x {who}_y", "m", "away", 2.0),
                *entries(f"{who}_vx {who}_vy", "m/s", "speed", "max_speed"),
            )
        ),
        *entries(" ".join(("restart", "barred")[:told]), most=1.0),
    )
    empty = (-AWAY, 0.0, 0.0, 0.0)
    groups = Group(_OWN, mates, empty), Group(_OWN + _EACH * mates, opponents, empty)
    name = f"team_view_{mates}_{opponents}{_RESTART_ENDINGS[told]}"
    return ObservationSpec(name, 1, vector, groups=groups)


def places_of(name: str) -> Places | None:
    """Return the places of the observation of that name, or None."""
    found = _TEAM_VIEW_NAME.fullmatch(name)
    if found is None:
        return None
    mates, opponents, told = found.groups()
    return Places(int(mates), int(opponents), _RESTART_ENDINGS.index(told))


def team_view_of(
    frame: Frame, robot: RobotState, mates: int, opponents: int, told: int = 0, barred: bool = False
) -> FloatArray:
    """Compute the state :func:`team_view` of one robot in a frame, (size,).

    ``barred`` says whether it may not touch the ball after its own restart, which frames do not contain.
    """
    team = [robot, *(mate for mate in frame.own if mate.id != robot.id)]
    robots = np.array([kinematics(each) for each in (*team, *frame.opponents)])
    field = frame.field
    row: FloatArray = team_view_rows(
        robots[None],
        np.array([motion(frame)]),
        _ME,
        len(team),
        mates,
        opponents,
        field.half_length,
        field.goal_width / 2,
        told,
    )[0]
    if told:
        row[-told:] = (frame.game.ball_for(frame.team), barred)[:told]
    return row


@compiled
def team_view_rows(
    robots: FloatArray,
    balls: FloatArray,
    who: NDArray[np.int64],
    blue: int,
    mates: int,
    opponents: int,
    goal_x: float,
    post_y: float,
    told: int,
) -> FloatArray:
    """Compute the states :func:`team_view` of the robots ``who`` in many arenas, (n, len(who) * size).

    Args:
        robots: (n, R, 6) x, y, heading, vx, vy, omega in field coordinates.
        balls: (n, 4) x, y, vx, vy.
        who: (L,) indices of the robots that observe.
        blue: number of robots, the first ones, that attack towards +x; the others towards -x.
        mates: number of places for team-mates.
        opponents: number of places for opponents.
        goal_x: where the goal lines are, either way [m].
        post_y: distance of the posts from the field's long axis [m].
        told: number of entries on restarts that follow each, left at 0.
    """
    places = Places(mates, opponents, told)
    rows = np.empty((len(robots), len(who) * _size(places)))
    away = np.empty(mates + opponents)
    everybody, rolling = robots.view(ROBOT)[..., 0], balls.view(BALL_RECORD)[..., 0]
    _fill_rows(everybody, rolling, who, blue, places, (goal_x, post_y), away, rows)
    return rows


@compiled_merged
def _size(places: Places) -> int:
    return _OWN + _EACH * (places.mates + places.opponents) + places.told


@compiled_merged
def _fill_rows(
    robots: NDArray[np.record],
    balls: NDArray[np.record],
    who: NDArray[np.int64],
    blue: int,
    places: Places,
    goal: Point,
    away: FloatArray,
    rows: FloatArray,
) -> None:
    size = _size(places)
    seen = size - places.told
    for i in range(len(robots)):
        for k in range(len(who)):
            row = rows[i, k * size : (k + 1) * size]
            index = who[k]
            first, last = (0, blue) if index < blue else (blue, robots.shape[1])
            row[seen:] = 0.0
            c, s = _observe(robots[i], balls[i], index, first, last, goal, row)
            others: Any = row[_OWN:seen].view(BALL_RECORD)
            mates, opponents = others[: places.mates], others[places.mates :]
            _nearest(robots[i], index, first, last, True, c, s, away[: places.mates], mates)
            _nearest(robots[i], index, first, last, False, c, s, away[places.mates :], opponents)


@compiled_merged
def _observe(
    robots: Sequence[Robot], ball: Ball, index: int, first: int, last: int, goal: Point, row: FloatArray
) -> Point:
    """Fill in all entries except robots; return cosine and sine of the heading."""
    me, sign = robots[index], 1.0 if first == 0 else -1.0
    c, s = cos(me.heading), sin(me.heading)
    goal_x, left = sign * goal[0], sign * goal[1]
    seen = row[:_OWN].view(_ITSELF_FIELDS)[0]
    seen.vx, seen.vy = turned(c, s, me.vx, me.vy)
    seen.omega = me.omega
    seen.x, seen.y, seen.cos_heading, seen.sin_heading = sign * me.x, sign * me.y, sign * c, sign * s
    seen.ball_x, seen.ball_y = turned(c, s, ball.x - me.x, ball.y - me.y)
    seen.ball_vx, seen.ball_vy = turned(c, s, ball.vx, ball.vy)
    seen.left_post_x, seen.left_post_y = turned(c, s, goal_x - me.x, left - me.y)
    seen.right_post_x, seen.right_post_y = turned(c, s, goal_x - me.x, -left - me.y)
    seen.own_goal_x, seen.own_goal_y = turned(c, s, -goal_x - me.x, -me.y)
    # A kicked ball keeps the velocity that it has across the heading.
    vx, vy = KICK_SPEED * c - seen.ball_vy * s, KICK_SPEED * s + seen.ball_vy * c
    fast = hypot(vx, vy)
    ahead = sign * vx > 0.1 * fast
    crosses = sign * (ball.y + (goal_x - ball.x) * vy / vx) if ahead else copysign(FAR_OFF, sign * vy)
    seen.aim = min(max(crosses, -FAR_OFF), FAR_OFF)
    lane = 0.5 * FAR_OFF
    for r, robot in enumerate(robots):
        if first <= r < last:
            continue
        dx, dy = robot.x - ball.x, robot.y - ball.y
        aside = (dy * vx - dx * vy) / fast
        if dx * vx + dy * vy > 0.0 and abs(aside) < abs(lane):
            lane = aside
    seen.lane = lane
    return c, s


@compiled_merged
def _nearest(
    robots: Sequence[Robot],
    index: int,
    first: int,
    last: int,
    mates: bool,
    c: float,
    s: float,
    away: FloatArray,
    places: Sequence[Ball],
) -> None:
    """Fill the places, one after the other, with the nearest mates, or opponents, of a robot."""
    me = robots[index]
    for place in range(len(away)):
        away[place] = inf
        empty = places[place]
        empty.x, empty.y, empty.vx, empty.vy = -AWAY, 0.0, 0.0, 0.0
    for r, other in enumerate(robots):
        if r == index or (first <= r < last) != mates:
            continue
        dx, dy = other.x - me.x, other.y - me.y
        far = dx * dx + dy * dy
        # Insert it behind those that are as near, and move the farther ones on.
        place = len(away)
        while place > 0 and far < away[place - 1]:
            place -= 1
            if place + 1 < len(away):
                away[place + 1] = away[place]
                _copy(places[place], places[place + 1])
        if place < len(away):
            away[place] = far
            seen = places[place]
            seen.x, seen.y = turned(c, s, dx, dy)
            seen.vx, seen.vy = turned(c, s, other.vx, other.vy)


@compilable
def _copy(here: Ball, there: Ball) -> None:
    there.x, there.y, there.vx, there.vy = here.x, here.y, here.vx, here.vy
