"""Each robot's delay, measured from what it was commanded and how it was seen to move."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from benchmarks.late_commands import PARTS, LateCommands
from robobt.sim import SimWorld, preset
from robobt.sim.realism import RealismSettings
from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch, MeasuredDelay
from robobt.world.detections import Detections
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.measured_prediction import MeasuredWorld
from robobt.world.protocol import Placement, WrappedWorld
from robobt.world.state import Frame, RobotId

PERIOD = 1 / 60
ROBOTS = [RobotId(team, number) for team in Team for number in range(3)]
REALISTIC = RealismSettings(robot_noise=0.0013, heading_noise=0.01, missing_robot=0.02)

Delays = Callable[[RobotId, float], float]


def field(
    delay: Delays,
    jitter: float = 0.01,
    lost: float = 0.03,
    realism: RealismSettings = REALISTIC,
    limits: RobotLimits | None = None,
    known: RobotLimits | None = None,
) -> MeasuredWorld:
    """A field on which six robots stand, which obey late."""
    own = preset("default", realism=realism)
    fast = SimWorld(DIVISION_B, dict.fromkeys(ROBOTS, limits), own, PERIOD / PARTS)
    late = LateCommands(fast, delay, jitter, lost)
    made = MeasuredWorld(late, DelayWatch(known or limits or own.limits), gaps=True)
    places = {robot: (-3.0 + i, 1.0 - i % 2, 0.0) for i, robot in enumerate(ROBOTS)}
    made.reset(Placement(places, (0.0, 2.9, 0.0, 0.0)), 1)
    return made


class Drivers:
    """Send robots to one place after another, as in play."""

    def __init__(self, seed: int) -> None:
        self._rng = np.random.default_rng(seed)
        self._targets: dict[RobotId, tuple[float, float, float, float]] = {}

    def decide(self, frame: Frame) -> dict[RobotId, RobotCommand]:
        return {robot: self._to_target(robot, frame) for robot in frame.robots()}

    def _to_target(self, robot: RobotId, frame: Frame) -> RobotCommand:
        me, rng = frame.robots()[robot], self._rng
        if frame.time >= self._targets.get(robot, (0.0,))[0]:
            until = frame.time + rng.uniform(0.3, 1.2)
            place = rng.uniform(-4.0, 4.0), rng.uniform(-2.5, 2.5), rng.uniform(-pi, pi)
            self._targets[robot] = until, *place
        _, x, y, heading = self._targets[robot]
        dx, dy, turn = x - me.x, y - me.y, (heading - me.heading + pi) % (2 * pi) - pi
        pace = min(2.0, 2.0 * hypot(dx, dy)) / max(hypot(dx, dy), 0.01)
        c, s = cos(me.heading), sin(me.heading)
        return RobotCommand(pace * (c * dx + s * dy), pace * (c * dy - s * dx), np.clip(3 * turn, -6, 6))


def play(made: MeasuredWorld, seconds: float, seed: int = 0) -> None:
    drivers = Drivers(seed)
    for _ in range(round(seconds / PERIOD)):
        made.act(drivers.decide(made.observe()))


def constant(delays: Sequence[float]) -> Delays:
    by_robot = dict(zip(ROBOTS, delays, strict=True))
    return lambda robot, _: by_robot[robot]


def errors(made: MeasuredWorld, delays: Sequence[float]) -> FloatArray:
    """By how much each measured delay is too long [s]; NaN where none is measured."""
    measured = [made.delays()[robot] for robot in ROBOTS]
    missed: FloatArray = np.array([np.nan if it is None else it.seconds for it in measured]) - delays
    return missed


@pytest.mark.integration
@settings(max_examples=4, phases=[Phase.generate])
@given(
    delays=st.lists(st.floats(0.02, 0.15), min_size=6, max_size=6),
    seed=st.integers(0, 1000),
)
def test_after_ten_seconds_each_delay_is_known_to_5_ms(delays: list[float], seed: int) -> None:
    made = field(constant(delays))
    play(made, 10.0, seed)
    missed = np.sort(np.abs(errors(made, delays)))
    # Chance decides which commands the radio hurries: about one robot in a hundred is missed by more.
    assert missed[-2] < 0.005
    assert missed[-1] < 0.01


@pytest.mark.integration
@settings(max_examples=2, phases=[Phase.generate])
@given(longer=st.booleans(), seed=st.integers(0, 1000))
def test_a_jump_of_40_ms_is_followed_in_three_seconds(longer: bool, seed: int) -> None:
    before, after = (0.06, 0.10) if longer else (0.10, 0.06)
    made = field(lambda _, time: before if time < 6.0 else after)
    play(made, 9.0, seed)
    missed = np.abs(errors(made, [after] * 6))
    assert np.median(missed) < 0.005
    assert missed.max() < 0.015


def test_robots_that_stand_say_nothing_of_their_delay() -> None:
    made = field(constant([0.08] * 6))
    for _ in range(180):
        made.observe()
        made.act({robot: RobotCommand() for robot in ROBOTS})
    assert made.delays() == dict.fromkeys(ROBOTS)


def test_without_noise_and_cameras_a_delay_is_measured_by_the_frames() -> None:
    made = field(constant([0.05] * 6), 0.0, 0.0, RealismSettings())
    play(made, 3.0)
    measured = made.delays()[ROBOTS[0]]
    assert measured is not None
    assert measured.seconds == pytest.approx(0.05, abs=0.003)
    assert measured.low < 0.05 < measured.high


@pytest.mark.integration
def test_the_age_of_the_vision_counts_whatever_its_timestamps_admit_to() -> None:
    seen = REALISTIC.model_copy(update={"vision_delay": 0.035, "processing_time": 0.01})
    made = field(constant([0.05] * 6), 0.0, 0.0, realism=seen)
    play(made, 6.0)
    for measured in made.delays().values():
        assert measured is not None
        assert measured.seconds == pytest.approx(0.085, abs=0.005)


class SlowCameras(WrappedWorld):
    """A world whose cameras show something in every second tick only."""

    ticks = 0

    def detections(self) -> Sequence[Detections]:
        self.ticks += 1
        return self.world.detections() if self.ticks % 2 else ()


@pytest.mark.integration
def test_cameras_that_are_slower_than_the_trees_are_still_what_a_delay_is_measured_by() -> None:
    seen = REALISTIC.model_copy(update={"vision_delay": 0.035, "processing_time": 0.035})
    made = field(constant([0.05] * 6), 0.0, 0.0, realism=seen)
    made.world = SlowCameras(made.world)
    play(made, 6.0)
    for measured in made.delays().values():
        assert measured is not None
        assert measured.seconds == pytest.approx(0.085, abs=0.005)


@pytest.mark.integration
def test_a_robot_with_a_lag_has_the_delay_beyond_it() -> None:
    robot = RobotLimits(dead_time=0.06, lag=0.04, side_lag=0.04, turn_lag=0.04, side_gain=0.8)
    made = field(constant([0.03] * 6), 0.0, 0.0, limits=robot)
    play(made, 6.0)
    for measured in made.delays().values():
        assert measured is not None
        assert measured.seconds == pytest.approx(0.09, abs=0.005)


@pytest.mark.integration
def test_robots_are_shown_where_the_next_command_finds_them() -> None:
    delay = 0.1
    made = field(constant([delay] * 6), jitter=0.0, lost=0.0, realism=RealismSettings())
    drivers, shown, real = Drivers(3), [], []
    for _ in range(240):
        frame = made.observe()
        shown.append([(robot.x, robot.y) for robot in frame.own])
        real.append([(robot.x, robot.y) for robot in made.truth().own])
        made.act(drivers.decide(frame))
    ticks = round(delay / PERIOD)
    misses = np.hypot(*np.moveaxis(np.array(shown)[120:-ticks] - np.array(real)[120 + ticks :], 2, 0))
    unpredicted = np.hypot(*np.moveaxis(np.array(real)[120:-ticks] - np.array(real)[120 + ticks :], 2, 0))
    assert np.median(misses) < 0.1 * np.median(unpredicted)


def test_a_robot_not_seen_enough_is_expected_to_be_as_late_as_the_others() -> None:
    own = RobotLimits(dead_time=0.03)
    made = field(lambda robot, _: 0.08, 0.0, 0.0, RealismSettings())
    watch = DelayWatch(own={ROBOTS[5]: own}, nominal=0.01)
    assert watch.expected(ROBOTS[5]) == pytest.approx(0.04)
    made = MeasuredWorld(made.world, watch)
    drivers = Drivers(0)
    for _ in range(180):
        commands = drivers.decide(made.observe())
        commands.pop(ROBOTS[5])
        made.act(commands)
    assert watch.of(ROBOTS[0]) is not None
    assert watch.of(ROBOTS[5]) is None
    assert watch.expected(ROBOTS[5]) == pytest.approx(0.08 + 0.03, abs=0.005)


def test_no_delay_may_be_below_nothing() -> None:
    assert MeasuredDelay(0.001, 0.002).low == 0.0
    assert MeasuredDelay(0.05, 0.002).low == pytest.approx(0.05 - 1.96 * 0.002)


def test_a_seed_fixes_what_is_measured() -> None:
    def measured() -> dict[RobotId, object]:
        made = field(constant([0.07] * 6))
        play(made, 2.0)
        return dict(made.delays())

    assert measured() == measured()


def test_what_was_measured_stays_known_when_robots_are_placed() -> None:
    made = field(constant([0.05] * 6), 0.0, 0.0, RealismSettings())
    play(made, 3.0)
    before = made.delays()
    assert None not in before.values()
    made.reset(Placement({robot: (-3.0 + i, -2.0, 0.0) for i, robot in enumerate(ROBOTS)}), 2)
    assert made.delays() == before


def test_a_watch_expects_as_another_that_was_made_for_the_same_robots() -> None:
    watch = DelayWatch(RobotLimits(), {ROBOTS[0]: RobotLimits(lag=0.04)}, nominal=0.05)
    assert watch.expects_as(DelayWatch(RobotLimits(), {ROBOTS[0]: RobotLimits(lag=0.04)}, nominal=0.05))
    assert not watch.expects_as(DelayWatch(RobotLimits(), nominal=0.05))
    assert not watch.expects_as(DelayWatch(RobotLimits(dead_time=0.01), nominal=0.05))
