"""Fields whose parameters are drawn from a seed, and play on them as their cameras see it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import ceil

import numpy as np

from robobt.identify.observations import Observations, without_repeats
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.scenario.scenario import Scenario
from robobt.sim import SimSettings, SimWorld
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import BallSettings
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import World, WrappedWorld
from robobt.world.state import Frame, RobotId

PERIOD = 1 / 60
"""Time between two pictures of the cameras [s]."""

_BELIEVED_DELAY = 0.07
"""Whole delay with which the team plays, which does not know the real one [s]."""

_ROBOTS = 6


@dataclass(slots=True)
class BlindField:
    """A field that nobody knows.

    Attributes:
        seed: that its parameters come from.
        settings: of the simulator.
        limits: of each robot.
        whole_delays: from a command to its seen effect, as the simulator's steps round it [s].
    """

    seed: int
    settings: SimSettings
    limits: dict[RobotId, RobotLimits]
    whole_delays: dict[RobotId, float]


def draw_field(seed: int) -> BlindField:
    """Return the field of a seed.

    Ranges cover the figures that teams published of real fields and robots: ball, one touch, speed and
    acceleration, 20 to 130 ms of whole delay, and noise up to ER-Force's level *Realistic*.
    """
    rng = np.random.default_rng([seed, 41])

    def between(low: float, high: float) -> float:
        return float(rng.uniform(low, high))

    ball = BallSettings(
        slide_deceleration=between(2.3, 4.0),
        switch_share=between(0.60, 0.72),
        roll_deceleration=between(0.2, 0.45),
        first_hop=between(0.7, 0.85),
        other_hops=between(0.85, 0.95),
        rebound=between(0.45, 0.57),
    )
    returned = between(0.0, 0.3)
    whole = between(0.020, 0.130)
    vision = between(0.015, min(0.045, whole))
    realism = RealismSettings(
        ball_noise=between(0.0004, 0.002),
        robot_noise=between(0.0003, 0.0015),
        heading_noise=between(0.003, 0.01),
        missing_ball=between(0.0, 0.05),
        missing_robot=between(0.0, 0.02),
        command_loss=between(0.0, 0.03),
        vision_delay=vision,
        # The rest of the delay is the robots' own.
        command_delay=0.003,
    )
    limits = {}
    kept = between(0.15, 0.8)
    for team in Team:
        usual = (between(2.0, 3.5), between(2.0, 4.5), between(2.5, 6.5), between(0.75, 1.0))
        for number in range(_ROBOTS):
            speed, acceleration, braking, side = (value * between(0.93, 1.07) for value in usual)
            limits[RobotId(team, number)] = RobotLimits(
                max_speed=speed,
                acceleration=acceleration,
                braking=braking,
                side_acceleration=side * acceleration,
                side_braking=side * braking,
                max_turn=between(6.0, 14.0),
                turn_acceleration=between(20.0, 60.0),
                dead_time=between(0.0, whole - vision),
                lag=between(0.02, 0.05),
                side_lag=between(0.02, 0.05),
                turn_lag=between(0.02, 0.04),
                gain=between(0.8, 1.0),
                side_gain=between(0.7, 1.0),
                turn_gain=between(0.9, 1.0),
                touch_kept=kept,
                touch_returned=returned,
            )
    # Last, so that all else of a seed's field is as it was before this was drawn.
    carried = between(-0.2, 0.9)
    limits = {robot: it.model_copy(update={"kick_carried": carried}) for robot, it in limits.items()}
    settings = SimSettings(ball=ball, realism=realism)
    step = PERIOD / ceil(PERIOD / settings.sub_step - 1e-9)
    seen = round(vision / step)
    delays = {
        robot: step * (seen + round((realism.command_delay + it.dead_time) / step))
        for robot, it in limits.items()
    }
    return BlindField(seed, settings, limits, delays)


def swapped(field: BlindField) -> BlindField:
    """Return the field on which each team has the other one's robots."""
    others = {robot: RobotId(robot.team.other, robot.number) for robot in field.limits}
    return replace(
        field,
        limits={robot: field.limits[other] for robot, other in others.items()},
        whole_delays={robot: field.whole_delays[other] for robot, other in others.items()},
    )


class _WatchedWorld(WrappedWorld):
    """A field as a team that does not know it sees it, and all that its cameras see and it sends.

    Blue's frames have the limits and the ball of the defaults; yellow knows its own robots.
    """

    def __init__(self, field: FieldGeometry, blind: BlindField) -> None:
        super().__init__(SimWorld(field, blind.limits, blind.settings, PERIOD))
        self._robots = sorted(blind.limits)
        self._field, self._losses = field, blind.settings.realism.missing_robot
        self._rows: dict[float, list[FloatArray]] = {}

    def observe(self) -> Frame:
        """See :meth:`robobt.world.World.observe`."""
        seen = self.world.observe()
        robots = seen.robots()
        poses = np.full((len(self._robots), 3), np.nan)
        for i, robot in enumerate(self._robots):
            if robot in robots:
                poses[i] = robots[robot].x, robots[robot].y, robots[robot].heading
        nothing = np.full((len(self._robots), 6), np.nan)
        self._rows[seen.time] = [np.array(seen.ball.position), poses, nothing]
        own = tuple([replace(robot, limits=DEFAULT_LIMITS) for robot in seen.own])
        return replace(seen, own=own, ball_model=DEFAULT_BALL)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`robobt.world.World.act`."""
        sent = next(reversed(self._rows.values()))[2]
        for i, robot in enumerate(self._robots):
            if robot.team is Team.BLUE:
                it = commands.get(robot, RobotCommand())
                sent[i] = it.vx, it.vy, it.omega, it.kick_speed, it.kick_angle, float(bool(it.dribbler))
        self.world.act(commands)

    def observations(self) -> Observations:
        """Return all that was seen and sent."""
        ball, poses, commands = (np.array(part) for part in zip(*self._rows.values(), strict=True))
        for i in range(len(self._robots)):
            poses[:, i] = without_repeats(poses[:, i])
        return Observations(
            self._field,
            tuple(self._robots),
            np.array(list(self._rows)),
            without_repeats(ball),
            poses,
            np.array(list(self._rows)),
            commands,
        )


def play(blind: BlindField, seconds: float, seed: int) -> Observations:
    """Return what the cameras saw, and blue sent, while two teams played on a field for some seconds."""
    scenario = load_scenario("six_v_six").lasting(seconds)
    worlds: list[_WatchedWorld] = []

    def make(scenario: Scenario) -> World:
        worlds.append(_WatchedWorld(scenario.field, blind))
        return PredictedWorld(worlds[-1], 0.035, _BELIEVED_DELAY - 0.035, gaps=True)

    with MatchLoop(scenario, seed, make) as match:
        while match.tick():
            pass
    return worlds[-1].observations()
