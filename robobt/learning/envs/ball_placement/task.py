"""Bring the ball to a spot and leave it there, judged by the challenge's own class."""

from __future__ import annotations

from functools import partial
from math import pi
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from robobt.challenges.ball_placement import PLACEMENT_TIME, PLACEMENTS
from robobt.config.validation import Settings
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.scripted import TAKEN_DISTANCE
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import START_COLUMNS, places_of, start_parts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.learning.envs.tick import Tick
from robobt.match.referee.rules.placement import CLEAR_DISTANCE, PlacedBalls
from robobt.models.actions import ActionScaling
from robobt.world.field import DIVISION_B
from robobt.world.observation import Seen, entries, own_observation
from robobt.world.rules import PLACED_DISTANCE

PLACEMENT_ACTION = ActionScaling(kind="drive_and_hold", max_speed=1.5, max_turn=3.0)
"""Slow enough for most dribblers to hold the ball, which is let go by the policy."""

_BEYOND_LINES = 0.15
"""Distance beyond the lines at which the balls at the boundary lie at most, as in the challenge [m]."""

_INSIDE_LINES = 0.2
"""Least distance of a spot from the lines, as in the challenge [m]."""

_FROM_BALL = 0.3
"""Least distance of the robot from the ball at the start [m]."""

_LEAVES_WITHIN = CLEAR_DISTANCE + 0.1
"""Distance from a placed ball up to which leaving it is rewarded [m]."""


def _rows(seen: Seen) -> FloatArray:
    """Observe ball and own motion; what is said of the spot is filled in by the task."""
    me, ball = seen.me, seen.balls
    columns = [
        *seen.in_frame_of_me(ball["x"] - me["x"], ball["y"] - me["y"]),
        *seen.in_frame_of_me(ball["vx"], ball["vy"]),
        *seen.in_frame_of_me(me["vx"], me["vy"]),
        me["omega"],
        np.cos(me["heading"]),
        np.sin(me["heading"]),
        ball["x"],
        ball["y"],
        np.zeros(len(me)),
        np.zeros(len(me)),
    ]
    return np.column_stack(columns)


BALL_TO_SPOT = own_observation(
    "ball_placement",
    1,
    *entries("ball_x ball_y", "m", "far", 0.5),
    *entries("ball_vx ball_vy", "m/s", "ball_speed", 1.0),
    *entries("vx vy", "m/s", "speed", "max_speed"),
    *entries("omega", "rad/s", "turn", "max_turn"),
    *entries("cos_heading sin_heading", most=1.0),
    *entries("field_x", "m", "far", 3.0),
    *entries("field_y", "m", "far", 2.0),
    *entries("way_x way_y", "m", "far", 0.5),
)(_rows)
"""What the robot observes: in its frame the ball, its own motion, and the way from the ball to the spot; on
the field its heading and the ball's place, which tells how near walls and goals are."""


class PlacementReward(Settings):
    """Weights of the reward."""

    placed: float = Field(5.0, description="for the ball placed")
    nearer: float = Field(1.0, description="for each metre that the ball gets nearer to its spot")
    approach: float = Field(
        0.3, description="for each metre that the robot gets nearer to a ball to be moved"
    )
    clear: float = Field(3.0, description="for each metre that the robot gets away from a ball at its spot")
    time: float = Field(-0.1, description="for each second")


class BallPlacementSettings(TaskSettings):
    """The settings of the task."""

    action: ActionScaling = PLACEMENT_ACTION
    time_limit: int = Field(
        int(PLACEMENT_TIME / 0.03), ge=1, le=100_000, description="ticks to the end of an episode"
    )
    decide_every: int = Field(2, ge=1, le=20, description="ticks for which an action holds")
    published: float = Field(
        0.25, ge=0, le=1, description="share of starts with ball and spot of one of the challenge's scenarios"
    )
    longest: float = Field(12.0, ge=0.6, le=20, description="longest way of the other starts' balls [m]")
    reward: PlacementReward = PlacementReward()

    @model_validator(mode="after")
    def _sensible(self) -> Self:
        if self.action.kind != "drive_and_hold":
            raise ValueError("action: Ball-Placement needs drive_and_hold actions")
        small = self.field.length < DIVISION_B.length or self.field.width < DIVISION_B.width
        if self.published > 0.0 and small:
            raise ValueError(
                "published: the challenge's scenarios need the field of division B; 0 draws none"
            )
        return self


class BallPlacementTask(ArenaTask):
    """Bring the ball to its spot and leave it there, as in the ball placement challenge of 2023.

    One robot is alone on the field; the challenge lets six play. An episode starts with the ball at rest, up
    to 0.15 m beyond the lines, and ends in success when the ball is placed by the class that the challenge's
    judge asks: at rest within 0.15 m of the spot, the robot 0.05 m away from it, 2 s or more after the start.
    """

    Settings = BallPlacementSettings
    settings: BallPlacementSettings
    observation = BALL_TO_SPOT
    start_columns = (*START_COLUMNS, "spot_x", "spot_y")
    _balls: PlacedBalls
    _spots: FloatArray

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw starts, one row each."""
        rows = np.zeros((count, len(self.start_columns)))
        robots, balls, rest = start_parts(rows, self.robots)
        lines = np.array([self.settings.field.half_length, self.settings.field.half_width])
        for row in range(count):
            if rng.random() < self.settings.published:
                ball, spot, _ = (np.array(part) for part in PLACEMENTS[rng.integers(len(PLACEMENTS))])
            else:
                ball = rng.uniform(-1.0, 1.0, 2) * (lines + _BEYOND_LINES)
                spot = self._spot(rng, ball, lines - _INSIDE_LINES)
            me = rng.uniform(-1.0, 1.0, 2) * lines
            while np.linalg.norm(me - ball) < _FROM_BALL:
                me = rng.uniform(-1.0, 1.0, 2) * lines
            robots["x"][row, 0], robots["y"][row, 0] = me
            robots["heading"][row, 0] = rng.uniform(-pi, pi)
            balls["x"][row], balls["y"][row] = ball
            rest[row] = spot
        return rows

    def _spot(self, rng: np.random.Generator, ball: FloatArray, lines: FloatArray) -> FloatArray:
        """Draw a spot within ``lines`` that is not too far from the ball, and not nearer than it may lie."""
        while True:
            way, towards = rng.uniform(PLACED_DISTANCE, self.settings.longest), rng.uniform(-pi, pi)
            spot: FloatArray = ball + way * np.array((np.cos(towards), np.sin(towards)))
            if (np.abs(spot) <= lines).all():
                return spot

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """Read the spots."""
        if not hasattr(self, "_balls"):
            self._balls, self._spots = PlacedBalls(self.n, self.settings.period), np.zeros((self.n, 2))
        _, balls, rest = start_parts(np.ascontiguousarray(starts), self.robots)
        self._spots[which] = rest
        self._balls.restart(which, places_of(balls))

    def ends(self, tick: Tick) -> tuple[BoolArray, BoolArray]:
        """End an episode when the ball is placed."""
        robots, balls = places_of(tick.now.robots), places_of(tick.now.balls)
        placed = self._balls.see(robots, balls, self._spots, tick.ticks * self.settings.period)
        return placed, np.zeros(self.n, dtype=np.bool_)

    def reward(self, tick: Tick) -> dict[str, FloatArray]:
        """Return the terms of :class:`PlacementReward`."""
        weights, before, now = self.settings.reward, self._worth(tick.before), self._worth(tick.now)
        return {
            "placed": weights.placed * tick.success,
            "nearer": weights.nearer * (now[0] - before[0]),
            "approach": weights.approach * (now[1] - before[1]),
            "clear": weights.clear * (now[2] - before[2]),
            "time": np.full(self.n, weights.time * self.settings.period),
        }

    def script(self) -> Policy:
        """Return a script that pulls the ball to its spot, lets it go and backs away."""
        return partial(_pull_and_leave, scaling=self.action)

    def _worth(self, seen: Seen) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return minus ball's and robot's way, and how far the robot is from a ball at its spot [m]."""
        ball = places_of(seen.balls)
        way: FloatArray = np.linalg.norm(ball - self._spots, axis=1)
        gap: FloatArray = np.linalg.norm(places_of(seen.me) - ball, axis=1)
        there = way <= PLACED_DISTANCE
        return -way, np.where(there, 0.0, -gap), np.where(there, np.minimum(gap, _LEAVES_WITHIN), 0.0)

    def _announce(self, seen: FloatArray, which: IntArray) -> None:
        now = self.now
        x, y = now.in_frame_of_me(*(self._spots - places_of(now.balls)).T)
        seen[:, -2:] = np.column_stack((x, y))[which]


def _pull_and_leave(observation: FloatArray, scaling: ActionScaling) -> FloatArray:
    """Drive to the ball, take it, pull it backwards to its spot, let go and back away, (n, 13) -> (n, 4)."""
    ball, now, way = observation[:, :2], observation[:, 4:6], observation[:, 11:13]
    far, length = np.hypot(*ball.T), np.hypot(*way.T)
    held = (far < TAKEN_DISTANCE) & (np.abs(ball[:, 1]) < TAKEN_DISTANCE / 3)
    there = length < 0.5 * PLACED_DISTANCE
    # With the ball its spot is to lie behind the robot.
    off = np.where(held, np.arctan2(-way[:, 1], -way[:, 0]), np.arctan2(ball[:, 1], ball[:, 0]))
    behind = np.where(np.abs(off) < 0.3, np.minimum(0.8, 0.1 + length), 0.0)[:, None]
    pull = behind * way / np.maximum(length, 1e-6)[:, None]
    wanted = np.where(
        held[:, None],
        pull,
        np.maximum(0.3, np.minimum(1.2, 1.5 * (far - 0.1)))[:, None] * ball / far[:, None],
    )
    wanted = np.where(there[:, None], [[-0.3, 0.0]], wanted)
    # The dribbler holds the ball only while the robot changes its velocity gently.
    change = wanted - now
    size = np.hypot(*change.T)[:, None]
    velocity = np.where(held[:, None], now + change * np.minimum(1.0, 0.06 / np.maximum(size, 1e-9)), wanted)
    omega = np.where(there, 0.0, np.clip(3.0 * off, -1.5, 1.5))
    return np.column_stack(
        (velocity / scaling.max_speed, omega / scaling.max_turn, np.where(there, -1.0, 1.0))
    )
