"""Carry the ball through the gates of the dribbling challenge, counted by the challenge's own class."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from robobt.challenges.dribbling import GateDribbling
from robobt.challenges.gates import POSTS_TOUCHED, GateCounter
from robobt.config.validation import Settings
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import MOUTH_GAP, columns_of, places_of, start_parts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.learning.envs.tick import Tick
from robobt.models.actions import ActionScaling
from robobt.skills.challenges.carry_along import GATE_POSTS, GATES
from robobt.world.geometry import Point
from robobt.world.observation import Seen, entries, own_observation
from robobt.world.rules import KEPT_GAP
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

POSTS = np.array([GateDribbling.posts[number] for number in sorted(GateDribbling.posts)])
"""The standing robots by their numbers [m]."""

DRIBBLING_ACTION = ActionScaling(kind="drive", max_speed=1.0, max_turn=3.0, dribbler=True)
"""Slow enough for most dribblers to hold the ball."""

_BEYOND_GATE = 0.22
"""Distance behind a gate's line at which robot and ball are through, however they are turned [m]."""

_CLEAR = 0.27
"""Least distance of the robot from a post at the start [m]."""

_INSIDE, _AROUND = (-3.5, -2.37), 0.05
"""Middle of the four robots around the ball, and how far from it episodes start there [m]."""

_IN_MOUTH = 0.13
"""A ball whose centre is within this distance of the robot's is in its mouth [m]."""

_BEYOND_E = ((-2.6, 2.0), (-2.7, 2.7))
"""Where the robot may be on its way to the last gate: x and y [m]."""


def _near_gate(rng: np.random.Generator, gate: str, sign: float) -> Point:
    """Return a place 0.25 to 0.4 m from a gate, on the side that its normal times ``sign`` points to."""
    a, b = (POSTS[number] for number in GATE_POSTS[gate])
    along = (b - a) / np.linalg.norm(b - a)
    normal = sign * np.array((along[1], -along[0]))
    x, y = 0.5 * (a + b) + rng.uniform(0.25, 0.4) * normal + rng.uniform(-0.1, 0.1) * along
    return float(x), float(y)


def _start(rng: np.random.Generator, passed: int) -> Point:
    """Return where a robot may be after its first ``passed`` gates."""
    gate = GATES[passed]
    if gate in "ABCD" and (gate == "D" or passed % 2 == 0):
        x, y = rng.uniform(-_AROUND, _AROUND, 2)
        return _INSIDE[0] + float(x), _INSIDE[1] + float(y)
    if gate in "ABC":
        # It comes back in; the normals of these gates point inwards.
        return _near_gate(rng, gate, -1.0)
    if gate == "E":
        # Through D before, or above this gate already.
        return _near_gate(rng, "D", -1.0) if rng.random() < 0.5 else _near_gate(rng, "E", -1.0)
    if rng.random() < 0.5:
        return _near_gate(rng, "F", 1.0)
    (x_low, x_high), (y_low, y_high) = _BEYOND_E
    return float(rng.uniform(x_low, x_high)), float(rng.uniform(y_low, y_high))


def _rows(seen: Seen) -> FloatArray:
    """Observe ball, own velocity and turning rate; what is said of gates is filled in by the task."""
    me, ball = seen.me, seen.balls
    columns = [
        *seen.in_frame_of_me(ball["x"] - me["x"], ball["y"] - me["y"]),
        *seen.in_frame_of_me(ball["vx"], ball["vy"]),
        *seen.in_frame_of_me(me["vx"], me["vy"]),
        me["omega"],
    ]
    rest = np.zeros((len(me), _GATE_ENTRIES))
    return np.column_stack((*columns, rest))


_OTHER_POSTS = 5
_GATE_ENTRIES = 8 + 2 * _OTHER_POSTS

DRIBBLING = own_observation(
    "dribbling",
    1,
    *entries("ball_x ball_y", "m", "far", 0.2),
    *entries("ball_vx ball_vy", "m/s", "ball_speed", 1.0),
    *entries("vx vy", "m/s", "speed", "max_speed"),
    *entries("omega", "rad/s", "turn", "max_turn"),
    *entries("beyond_x beyond_y", "m", "far", 0.5),
    *entries("right_x right_y left_x left_y", "m", "far", 0.5),
    *entries("next_x next_y", "m", "far", 0.5),
    *(
        entry
        for index in range(_OTHER_POSTS)
        for entry in entries(f"post_{index}_x post_{index}_y", "m", "far", 0.5)
    ),
)(_rows)
"""What the robot observes, in its frame: ball, own motion, the point beyond the next gate, that gate's posts
on its right and left, the middle of the gate after it, and the other posts, nearest first."""


class DribblingReward(Settings):
    """Weights of the reward."""

    gate: float = Field(5.0, description="for a gate")
    touch: float = Field(-5.0, description="for a touch or a ball out, which ends the episode")
    nearer: float = Field(2.0, description="for each metre that robot and ball get nearer to beyond the gate")
    loose: float = Field(-1.0, description="for each second without the ball")
    time: float = Field(-0.2, description="for each second")


class DribblingSettings(TaskSettings):
    """The settings of the task."""

    action: ActionScaling = DRIBBLING_ACTION
    time_limit: int = Field(400, ge=1, le=100_000, description="ticks to the end of an episode")
    first: tuple[int, int] = Field(
        (0, len(GATES) - 1), description="fewest and most gates that have been passed at the start"
    )
    gates: int = Field(1, ge=1, le=len(GATES), description="gates to pass, or those that are left")
    reward: DribblingReward = DribblingReward()

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        low, high = self.first
        if not 0 <= low <= high < len(GATES):
            raise ValueError(f"first: must be from 0 to {len(GATES) - 1}, the smaller first")
        return self


class DribblingTask(ArenaTask):
    """Carry the ball through the next gates of the dribbling challenge of 2022, touching none of its robots.

    An episode starts with the ball in the dribbler, before any of the gates. It
    succeeds after ``gates`` more gates, counted by the class that the challenge's judge asks, and fails at a
    touch or when the ball leaves the field. With ``first: [0, 0]``, ``gates: 9`` and ``time_limit: 4000``
    (120 s) it is the whole challenge, except that the robot starts with the ball.
    """

    Settings = DribblingSettings
    settings: DribblingSettings
    observation = DRIBBLING
    robots = 1 + len(POSTS)
    start_columns = (*columns_of(1 + len(POSTS)), "passed")
    _counter: GateCounter
    _wanted: IntArray
    _new: BoolArray
    _nearer: FloatArray

    @property
    def passed(self) -> IntArray:
        """Number of gates passed in each arena, those before the episode too, (n,)."""
        return self._counter.passed

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw starts, one row each."""
        rows = np.zeros((count, len(self.start_columns)))
        robots, balls, rest = start_parts(rows, self.robots)
        robots["x"][:, 1:], robots["y"][:, 1:] = POSTS.T
        ahead = self.settings.simulator.body.face + BALL_RADIUS + MOUTH_GAP
        low, high = self.settings.first
        rest[:, 0] = rng.integers(low, high + 1, count)
        for row in range(count):
            while True:
                x, y = _start(rng, int(rest[row, 0]))
                heading = float(rng.uniform(-pi, pi))
                ball = x + ahead * np.cos(heading), y + ahead * np.sin(heading)
                clear = np.hypot(POSTS[:, 0] - x, POSTS[:, 1] - y).min() >= _CLEAR
                free = np.hypot(POSTS[:, 0] - ball[0], POSTS[:, 1] - ball[1]).min() > ROBOT_RADIUS + 0.03
                if clear and free and self.settings.field.contains(*ball, -0.05):
                    break
            robots[row]["x"][0], robots[row]["y"][0], robots[row]["heading"][0] = x, y, heading
            balls["x"][row], balls["y"][row] = ball
        return rows

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """Read how many gates have been passed."""
        if not hasattr(self, "_counter") or len(self._counter.passed) != self.n:
            self._counter, self._wanted = GateCounter(self.n), np.zeros(self.n, dtype=np.int64)
        _, _, rest = start_parts(np.ascontiguousarray(starts), self.robots)
        passed = rest[:, 0].astype(np.int64)
        self._counter.restart(which, passed)
        self._wanted[which] = np.minimum(passed + self.settings.gates, len(GATES))

    def ends(self, tick: Tick) -> tuple[BoolArray, BoolArray]:
        """End an episode after the last gate that is asked for, and at a touch or with the ball out."""
        me, ball = places_of(tick.now.me), places_of(tick.now.balls)
        posts = places_of(tick.now.opponents)
        target, _ = self._beyond(tick.before)
        before = _gap(tick.before, target)
        self._new = self._counter.see(posts, me, ball, self._kept(tick.now))
        self._nearer = before - _gap(tick.now, target)
        touch = (np.linalg.norm(posts - me[:, None], axis=2) <= POSTS_TOUCHED).any(axis=1)
        half = np.array([self.settings.field.half_length, self.settings.field.half_width]) + BALL_RADIUS
        failed = touch | (np.abs(ball) > half).any(axis=1)
        return (self._counter.passed >= self._wanted) & ~failed, failed

    def reward(self, tick: Tick) -> dict[str, FloatArray]:
        """Return the terms of :class:`DribblingReward`."""
        weights, period = self.settings.reward, self.settings.period
        return {
            "gate": weights.gate * (self._new & ~tick.failed),
            "touch": weights.touch * tick.failed,
            "nearer": weights.nearer * self._nearer,
            "loose": weights.loose * period * ~self._kept(tick.now),
            "time": np.full(self.n, weights.time * period),
        }

    def script(self) -> Policy:
        """Return a script that turns to the point beyond the gate and drives there."""
        return partial(_turn_and_carry, max_turn=self.action.max_turn)

    def _announce(self, seen: FloatArray, which: IntArray) -> None:
        now = self.now
        beyond, order = self._beyond(now)
        gate = self._counter.gate(places_of(now.opponents))
        # Right and left as the robot passes through.
        right, left = (gate[np.arange(self.n), end] for end in (order, 1 - order))
        later = GateCounter(self.n)
        later.passed = np.minimum(self._counter.passed + 1, len(GATES) - 1)
        after = later.gate(places_of(now.opponents)).mean(axis=1)
        posts = places_of(now.opponents)
        others = _others(self._counter.passed, posts, places_of(now.me))
        columns: list[FloatArray] = []
        for place in (beyond, right, left, after, *np.moveaxis(others, 1, 0)):
            columns += now.in_frame_of_me(place[:, 0] - now.me["x"], place[:, 1] - now.me["y"])
        seen[:, -_GATE_ENTRIES:] = np.column_stack(columns)[which]

    def _kept(self, seen: Seen) -> BoolArray:
        gap = np.hypot(seen.me["x"] - seen.balls["x"], seen.me["y"] - seen.balls["y"])
        kept: BoolArray = gap - ROBOT_RADIUS - BALL_RADIUS <= KEPT_GAP
        return kept

    def _beyond(self, seen: Seen) -> tuple[FloatArray, IntArray]:
        """Return the point beyond the next gate, (n, 2), and which of its posts is on the right, (n,)."""
        gate = self._counter.gate(places_of(seen.opponents))
        a, b = gate[:, 0], gate[:, 1]
        along = (b - a) / np.linalg.norm(b - a, axis=1)[:, None]
        normal = np.column_stack((along[:, 1], -along[:, 0]))
        here = ((places_of(seen.me) - a) * normal).sum(axis=1)
        side = np.where(self._counter.side == 0, np.where(here > 0.0, 1, -1), self._counter.side)
        return 0.5 * (a + b) - _BEYOND_GATE * side[:, None] * normal, np.where(side > 0, 1, 0)


def _others(passed: IntArray, posts: FloatArray, me: FloatArray) -> FloatArray:
    """Return the posts that are not the next gate's, (n, 5, 2), nearest to the robot first."""
    ends = np.array([GATE_POSTS[gate] for gate in GATES])[np.minimum(passed, len(GATES) - 1)]
    gaps = np.linalg.norm(posts - me[:, None], axis=2)
    np.put_along_axis(gaps, ends, np.inf, axis=1)
    order = np.argsort(gaps, axis=1)[:, :_OTHER_POSTS]
    return np.take_along_axis(posts, order[..., None], axis=1)


def _gap(seen: Seen, target: FloatArray) -> FloatArray:
    """Return the mean distance of robot and ball from a point [m]."""
    me, ball = (np.linalg.norm(places_of(one) - target, axis=1) for one in (seen.me, seen.balls))
    gap: FloatArray = 0.5 * (me + ball)
    return gap


def _turn_and_carry(observation: FloatArray, max_turn: float) -> FloatArray:
    """Turn to the ball, or with it to the point beyond the gate, and drive there, (n, O) -> (n, 3)."""
    lost = np.hypot(*observation[:, :2].T) > _IN_MOUTH
    x, y = np.where(lost[:, None], observation[:, :2], observation[:, 7:9]).T
    off = np.arctan2(y, x)
    speed = np.where(np.abs(off) < 0.3, 0.4, 0.0)
    return np.column_stack(
        (speed * np.cos(off), speed * np.sin(off), np.clip(3.0 * off, -1.5, 1.5) / max_turn)
    )
