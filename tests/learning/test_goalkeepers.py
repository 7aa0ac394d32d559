"""The compiled goalkeepers decide what the plays ``goalkeeper`` and ``fitted_goalkeeper`` decide."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from robobt.learning.opponents.goalkeeper_cases import Case
from robobt.learning.opponents.goalkeepers import FittedGoalkeepers, Goalkeepers
from robobt.plays import goalkeeper
from robobt.plays.goalkeeper import fitted_goalkeeper
from robobt.sim.arenas import Arenas
from robobt.sim.settings import preset
from robobt.testing import frame, robot
from robobt.testing.frames import HELD
from robobt.world import RobotLimits
from robobt.world.field import DIVISION_B
from robobt.world.geometry import FloatArray, wrap_angle
from tests.skills.fixed_world import Alone

NAMES = ("aim", "shot", "fetch", "clear", "CoverAngle", "ReturnToGoal")
PERIOD, TICKS = 0.03, 4
LATE = RobotLimits(max_speed=2.5, acceleration=4.0, side_acceleration=3.0, reaction=0.02)


def scenes(n: int, rng: np.random.Generator) -> tuple[FloatArray, FloatArray]:
    """Robots (n, 2, 6), the goalkeeper's first, and balls (n, 4) as the goalkeeper's team sees them.

    The ball is anywhere, in the attacker's mouth, on its way to the goal, or at rest about the area.
    """
    kind = rng.integers(0, 4, n)
    robots = np.zeros((n, 2, 6))
    robots[:, 0, 0], robots[:, 0, 1] = rng.uniform(-4.6, -2.5, n), rng.uniform(-1.5, 1.5, n)
    robots[:, 1, 0], robots[:, 1, 1] = rng.uniform(-4.0, 2.0, n), rng.uniform(-2.5, 2.5, n)
    robots[:, :, 2] = rng.uniform(-pi, pi, (n, 2))
    robots[:, :, 3:5] = rng.uniform(-1.5, 1.5, (n, 2, 2))
    robots[:, :, 5] = rng.uniform(-3.0, 3.0, (n, 2))
    balls = np.column_stack((rng.uniform(-4.7, 2.0, n), rng.uniform(-2.5, 2.5, n), np.zeros((n, 2))))
    balls[kind == 0, 2:] = rng.uniform(-2.0, 2.0, (n, 2))[kind == 0]
    heading = robots[:, 1, 2]
    towards = np.arctan2(-robots[:, 1, 1], -4.5 - robots[:, 1, 0]) + rng.normal(0.0, 0.2, n)
    heading[kind == 1] = towards[kind == 1]
    ahead = np.column_stack((np.cos(heading), np.sin(heading)))
    mouth = np.hstack((robots[:, 1, :2] + HELD * ahead, robots[:, 1, 3:5]))
    balls[kind == 1] = mouth[kind == 1]
    speed = rng.uniform(0.2, 6.0, n)
    aimed = np.arctan2(rng.uniform(-0.7, 0.7, n) - balls[:, 1], -4.6 - balls[:, 0])
    balls[kind == 2, 2:] = np.column_stack((speed * np.cos(aimed), speed * np.sin(aimed)))[kind == 2]
    near = np.column_stack((rng.uniform(-4.5, -3.3, n), rng.uniform(-1.2, 1.2, n), np.zeros((n, 2))))
    balls[kind == 3] = near[kind == 3]
    return robots, balls


def turned(robots: FloatArray, balls: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The same in field coordinates, where the goalkeeper defends the goal at +x."""
    there = -robots
    there[..., 2] = np.vectorize(wrap_angle)(robots[..., 2] + pi)
    there[..., 5] = robots[..., 5]
    return there, -balls


@pytest.mark.parametrize("speed", [1.0, 0.5])
@pytest.mark.parametrize("limits", [RobotLimits(), LATE], ids=["default", "late"])
def test_it_decides_as_the_tree_on_random_frames(limits: RobotLimits, speed: float) -> None:
    keepers = Goalkeepers(DIVISION_B, limits, PERIOD, 150, speed)
    decides_as(keepers, [Alone(goalkeeper(speed_factor=speed)) for _ in range(150)], limits, NAMES)


@pytest.mark.parametrize("limits", [RobotLimits(), LATE], ids=["default", "late"])
def test_the_fitted_one_decides_as_its_tree_on_random_frames(limits: RobotLimits) -> None:
    speeds = np.linspace(0.7, 1.4, 150)
    keepers = FittedGoalkeepers(DIVISION_B, limits, PERIOD, 150, acceleration=3.5, braking=1.2)
    keepers.restart(np.arange(150), speeds)
    trees = [
        Alone(fitted_goalkeeper(max_speed=speed, acceleration=3.5, braking=1.2)) for speed in speeds.tolist()
    ]
    decides_as(keepers, trees, limits, (*NAMES[:4], "CoverNearPost", "ReturnToGoal"))


def test_the_fitted_one_does_what_it_decided_a_delay_before() -> None:
    rng = np.random.default_rng(5)
    robots, balls = turned(*scenes(20, rng))
    contact = np.zeros((20, 2), dtype=bool)
    at_once, late = (FittedGoalkeepers(DIVISION_B, RobotLimits(), PERIOD, 20, delay=d) for d in (0.0, 0.036))
    told = np.zeros((5, 2, 20, 6))
    for tick in range(5):
        for keepers, row in zip((at_once, late), told[tick], strict=True):
            keepers.decide(robots, balls, contact, 0, row)
        robots[..., :2] += 0.01
    assert told[:, 0].any()
    np.testing.assert_allclose(told[2:, 1], 0.2 * told[:-2, 0] + 0.8 * told[1:-1, 0], atol=1e-12)


def decides_as(keepers: Goalkeepers, trees: list[Alone], limits: RobotLimits, names: tuple[str, ...]) -> None:
    """Statement: on random frames each plays the case that its tree plays, with the same command."""
    n, rng = len(trees), np.random.default_rng(4)
    robots, balls = scenes(n, rng)
    contact = rng.random((n, 2)) < 0.1
    contact &= np.hypot(*(balls[:, None, :2] - robots[..., :2]).transpose(2, 0, 1)) < 0.12
    commands, seen = np.empty((n, 6)), set()
    for tick in range(TICKS):
        keepers.decide(*turned(robots, balls), contact, 0, commands)
        for i, tree in enumerate(trees):
            (me, other), ball = robots[i].tolist(), tuple(balls[i].tolist())
            keeper, attacker = (
                robot(*pose[:3], 0, tuple(pose[3:]), bool(contact[i, k]), limits)
                for k, pose in enumerate((me, other))
            )
            now = frame(keeper, ball, opponents=(attacker,), time=tick * PERIOD, period=PERIOD)
            tree.tick(now)
            tip = tree.tree.tip()
            assert tip is not None
            assert tip.parent is not None
            name = tip.name if tip.parent is tree.tree else tip.parent.name
            case = int(keepers.cases[i])
            seen.add(case)
            assert name == names[case]
            if case in (Case.FETCH, Case.CLEAR):
                assert (commands[i] == 0.0).all()
                continue
            told = tree.command
            wanted = (told.vx, told.vy, told.omega, 0.0, 0.0, float(told.dribbler))
            assert commands[i] == pytest.approx(wanted, abs=1e-6), (name, i)
        # The next frame, as if nobody had done anything.
        robots[..., :2] += PERIOD * robots[..., 3:5]
        balls[:, :2] += PERIOD * balls[:, 2:]
        balls[:, 2:] *= rng.choice([0.9, 0.99, 1.0], (n, 1))
    assert seen == set(Case)


def shots(n: int, arenas: int) -> tuple[FloatArray, FloatArray]:
    """Shots at 2.5 m/s, the first ``n`` of a fixed row of them, on goalkeepers that stand at home.

    The goalkeepers' places (ticks, n, 6), and the farthest x of each ball (n,); so many ``arenas`` at once.
    """
    aims = np.linspace(-0.35, 0.35, 8)[:n]
    tracks, farthest = [], []
    for first in range(0, n, arenas):
        aim = aims[first : first + arenas]
        world = Arenas(DIVISION_B, [None], preset("default"), PERIOD, len(aim))
        balls = np.column_stack(
            (np.ones_like(aim), np.zeros_like(aim), np.full_like(aim, 2.5), aim * 2.5 / 3.5)
        )
        world.place(np.tile([4.35, 0.0, pi], (len(aim), 1)), balls)
        keepers = Goalkeepers(DIVISION_B, preset("default").limits, PERIOD, len(aim))
        commands, track, most = np.empty((len(aim), 1, 6)), [], np.zeros(len(aim))
        for _ in range(100):
            keepers.decide(world.robots, world.balls, world.contact, 0, commands[:, 0])
            world.step(commands)
            track.append(world.robots[:, 0].copy())
            most = np.maximum(most, world.balls[:, 0])
        tracks.append(np.array(track))
        farthest.append(most)
    return np.concatenate(tracks, axis=1), np.concatenate(farthest)


def test_it_saves_slow_shots_in_every_arena() -> None:
    _, farthest = shots(8, 8)
    assert (farthest < DIVISION_B.half_length).all()


def test_what_it_does_does_not_depend_on_the_number_of_arenas() -> None:
    together, alone = shots(8, 8)[0], shots(8, 1)[0]
    assert np.array_equal(together, alone)


def test_a_restarted_goalkeeper_has_forgotten_the_ball_that_it_fetched() -> None:
    robots, contact = np.tile([4.35, 0.0, pi, 0.0, 0.0, 0.0], (2, 1, 1)), np.zeros((2, 1), dtype=bool)
    keepers, commands = Goalkeepers(DIVISION_B, RobotLimits(), PERIOD, 2), np.empty((2, 6))
    keepers.decide(robots, np.tile([3.4, 0.0, 0.0, 0.0], (2, 1)), contact, 0, commands)
    assert keepers.cases.tolist() == [Case.FETCH, Case.FETCH]
    keepers.restart(np.array([1]))
    keepers.decide(robots, np.tile([3.4, 0.0, -0.3, 0.0], (2, 1)), contact, 0, commands)
    assert keepers.cases.tolist() == [Case.FETCH, Case.COVER]


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_a_speed_that_is_none_is_an_error(speed: float) -> None:
    with pytest.raises(ValueError, match="speed must be above 0"):
        Goalkeepers(DIVISION_B, RobotLimits(), PERIOD, 2, [1.0, speed])
