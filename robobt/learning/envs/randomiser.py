"""Domain randomisation: parameters that differ between an arena's episodes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robobt.learning.envs.settings import RandomisationSettings, Span, TaskSettings
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.sim.arenas import Arenas

_ACCELERATIONS = ("acceleration", "braking", "lateral_acceleration", "lateral_braking", "turn_acceleration")


_LAGS = ("lag", "side_lag", "turn_lag")
_GAINS = ("gain", "side_gain", "turn_gain")
_ANSWERS = ("lag", "gain", "touch_kept", "touch_returned")


class Randomiser:
    """Sets each arena's parameters at the start of an episode.

    Speed, accelerations and kicks are changed for an arena's first robot, the learner.

    Attributes:
        kick: (n,) factor on the speed of kicks.
        acceleration: (n,) factor on the robot's accelerations.
        top_speed: (n,) factor on its top speed.
    """

    def __init__(self, settings: TaskSettings, arenas: Arenas, rngs: Sequence[np.random.Generator]) -> None:
        n = len(arenas.balls)
        self.kick = np.ones(n)
        self.acceleration = np.ones(n)
        self.top_speed = np.ones(n)
        self._ranges = settings.randomisation
        none = RandomisationSettings()
        self._active = self._ranges != none
        # Drawn beside the others only where asked for, so that a seed draws what it drew without them.
        self._answers = any(getattr(self._ranges, name) != getattr(none, name) for name in _ANSWERS)
        self._arenas = arenas
        self._rngs = rngs
        self._arena_parameters = arenas.arena_parameters.copy()
        self._robot_parameters = arenas.robot_parameters.copy()
        self._grip = arenas.wheel_parameters["tangent_friction"].copy()
        self._mass = settings.simulator.body.mass
        if settings.simulator.kicker.speed_spread > 0.0:
            arenas.seed([int(rng.integers(2**31)) for rng in rngs])

    def draw(self, which: IntArray) -> None:
        """Draw the parameters of these arenas at the start of their episodes."""
        if not self._active:
            return
        arenas, ranges = self._arenas, self._ranges
        drawn = np.array([self._rngs[arena].random(7) for arena in which.tolist()]).T
        friction, acceleration, mass, kick, dribbler, delay, top_speed = drawn
        friction = _within(ranges.friction, friction)
        self.acceleration[which] = _within(ranges.acceleration, acceleration)
        mass = _within(ranges.mass, mass)
        self.kick[which] = _within(ranges.kick_speed, kick)
        dribbler = _within(ranges.dribbler, dribbler)
        delay = _within(ranges.control_delay, delay)
        self.top_speed[which] = _within(ranges.top_speed, top_speed)
        own, now = self._arena_parameters, arenas.arena_parameters
        for name in ("slide_deceleration", "roll_deceleration"):
            now["ball"][name][which] = own["ball"][name][which] * friction
        for name in ("pull", "side"):
            now["dribbler"][name][which] = own["dribbler"][name][which] * dribbler
        own, now = self._robot_parameters[:, 0], arenas.robot_parameters[:, 0]
        for name in _ACCELERATIONS:
            now[name][which] = own[name][which] * self.acceleration[which]
        now["max_speed"][which] = own["max_speed"][which] * self.top_speed[which]
        arenas.wheel_parameters["tangent_friction"][which] = self._grip[which] * self.acceleration[which]
        if ranges.mass != (1.0, 1.0):
            for arena, factor in zip(which.tolist(), mass.tolist(), strict=True):
                arenas.weigh(arena, self._mass * factor)
        if ranges.control_delay != (0.0, 0.0):
            arenas.delay_commands(which, delay)
        if self._answers:
            self._draw_answer(which)

    def _draw_answer(self, which: IntArray) -> None:
        """Draw how the robot answers its commands, and its kick's touch."""
        ranges, own, now = self._ranges, self._robot_parameters[:, 0], self._arenas.robot_parameters[:, 0]
        drawn = np.array([self._rngs[arena].random(7) for arena in which.tolist()]).T
        for name, share in zip(_LAGS, drawn[:3], strict=True):
            now[name][which] = own[name][which] + _within(ranges.lag, share)
        for name, share in zip(_GAINS, drawn[3:6], strict=True):
            now[name][which] = own[name][which] * _within(ranges.gain, share)
        if ranges.touch_kept is not None:
            now["touch_kept"][which] = _within(ranges.touch_kept, drawn[6])
        if ranges.touch_returned is not None:
            share = np.array([self._rngs[arena].random() for arena in which.tolist()])
            now["touch_returned"][which] = _within(ranges.touch_returned, share)


def _within(span: Span, share: FloatArray) -> FloatArray:
    least, most = span
    return least + (most - least) * share
