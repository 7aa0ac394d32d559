"""Late frames brought up to now with the commands on their way."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from robobt.match.loop import MatchLoop
from robobt.match.scenario.scenario import load_scenario
from robobt.sim import SimWorld, preset
from robobt.sim.realism import RealismSettings
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.delay import DelayWatch
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.measured_prediction import MeasuredWorld
from robobt.world.predicted_ball import PLACE
from robobt.world.prediction import PredictedWorld
from robobt.world.protocol import Placement
from robobt.world.state import BALL_RADIUS, Frame, RobotId
from robobt.worlds import sim_world

BLUE, YELLOW = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 3)
PERIOD = 0.03


def world(ball: tuple[float, float] = (2.0, 2.0), **realism: float) -> PredictedWorld:
    late = RealismSettings(**realism)
    # Its robots follow their commands within their limits, which is what the prediction reckons with.
    settings = preset("rsim", realism=late)
    sim = SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, settings, PERIOD)
    made = PredictedWorld(sim, late.vision_delay, late.command_delay, gaps=late.missing_robot > 0.0)
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.5), YELLOW: (1.0, 1.0, -2.0)}, (*ball, 0.0, 0.0)), 1)
    return made


def drive(made: PredictedWorld, ticks: int, command: RobotCommand) -> tuple[Frame, Frame]:
    """What is shown at the end, and what is."""
    for _ in range(ticks):
        made.observe()
        made.act({BLUE: command, YELLOW: command})
    return made.observe(), made.truth()


def off(shown: Frame, real: Frame) -> float:
    """Largest distance between where robots are shown and where they are [m]."""
    pairs = zip(shown.own + shown.opponents, real.own + real.opponents, strict=True)
    return max(math.hypot(a.x - b.x, a.y - b.y) for a, b in pairs)


@pytest.mark.parametrize("ticks", [1, 2, 3, 10, 30])
@pytest.mark.parametrize("delay", [0.01, 0.035, 0.1])
def test_robots_are_shown_where_they_are(ticks: int, delay: float) -> None:
    made = world(vision_delay=delay)
    shown, real = drive(made, ticks, RobotCommand(2.0, 0.5, 3.0))
    assert off(shown, real) < 1e-3
    assert shown.own[0].heading == pytest.approx(real.own[0].heading, abs=1e-3)
    assert shown.own[0].vx == pytest.approx(real.own[0].vx, abs=1e-2)
    assert shown.own[0].omega == pytest.approx(real.own[0].omega, abs=1e-2)


def test_without_it_they_are_not() -> None:
    made = world(vision_delay=0.1)
    _, real = drive(made, 30, RobotCommand(2.0, 0.5, 3.0))
    assert off(made.world.observe(), real) > 0.1


def test_a_command_delay_is_reckoned_with() -> None:
    """What is shown is what the next command will meet."""
    made = world(vision_delay=0.03, command_delay=0.06)
    shown, _ = drive(made, 10, RobotCommand(1.0, 0.0, 0.0))
    for _ in range(2):
        made.act({BLUE: RobotCommand(), YELLOW: RobotCommand()})
    assert off(shown, made.truth()) < 2e-3


@pytest.mark.parametrize(
    ("name", "off_by", "speed_off_by"),
    # Wheels slip, which no prediction knows. Without their frame of reaction it is 1.84 mm and 60 mm/s.
    [("default", 1e-3, 0.01), ("erforce", 1e-3, 0.01), ("real_2025", 0.0015, 0.01), ("grsim", 0.0017, 0.055)],
)
def test_a_robot_is_shown_when_the_next_command_moves_it(
    name: str, off_by: float, speed_off_by: float
) -> None:
    realism = RealismSettings(vision_delay=0.03, command_delay=0.02)
    settings = preset(name, realism=realism)
    sim = SimWorld(DIVISION_B, {BLUE: None}, settings, 1 / 60)
    made = PredictedWorld(sim, realism.vision_delay, realism.command_delay)
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0)}, (3.0, 2.0, 0.0, 0.0)), 1)
    ahead = settings.limits.shown_after(realism.command_delay)
    shown, real = [], []
    for tick in range(300):
        now, me = made.observe(), made.truth().own[0]
        real.append((now.time, me.x, me.y, me.vx, me.vy))
        me = now.own[0]
        shown.append((now.time + ahead, me.x, me.y, me.vx, me.vy))
        turn, way = 0.03 * tick, (1.0, -0.5)[tick // 30 % 2]
        command = RobotCommand(way * math.cos(turn), math.sin(turn), 2.0 * (-1) ** (tick // 20))
        made.act({BLUE: command})
    times, *columns = np.array(real).T
    off, speed_off = [], []
    for time, *told in shown[100:-14]:
        x, y, vx, vy = (a - float(np.interp(time, times, b)) for a, b in zip(told, columns, strict=True))
        off.append(math.hypot(x, y))
        speed_off.append(math.hypot(vx, vy))
    assert np.mean(off) < off_by
    assert np.mean(speed_off) < speed_off_by


@pytest.mark.parametrize("name", ["default", "grsim", "erforce", "real_2025"])
def test_what_is_expected_before_a_delay_is_measured_is_what_is_known(name: str) -> None:
    realism = {"vision_delay": 0.03, "command_delay": 0.02}
    scenario = load_scenario("striker_vs_goalkeeper")
    changes = {"simulator": {"preset": name, "realism": realism}}
    places = []
    for predict in (True, "measured"):
        with MatchLoop(scenario.model_copy(update={**changes, "predict": predict}), 1, sim_world) as match:
            for _ in range(10):
                match.tick()
            robots = match.world.observe().robots()
            places.append([(it.x, it.y, it.heading, it.vx, it.vy) for it in robots.values()])
    known, measured = places
    assert np.allclose(known, measured, atol=1e-6)


def test_a_speed_too_small_to_divide_by_is_predicted(monkeypatch: pytest.MonkeyPatch) -> None:
    made = world(vision_delay=0.03)
    drive(made, 5, RobotCommand())
    seen = made.world.observe()
    seen.own[0].vx = 5e-324
    monkeypatch.setattr(made.world, "observe", lambda: seen)
    assert made.observe().own[0].vx == pytest.approx(0.0)


def test_a_ball_in_the_mouth_goes_with_its_robot() -> None:
    made = world(ball=(-0.5, 0.273), vision_delay=0.06)
    for _ in range(40):
        made.observe()
        made.act({BLUE: RobotCommand(1.0, dribbler=True)})
    for _ in range(5):
        made.observe()
        made.act({BLUE: RobotCommand(1.0, omega=4.0, dribbler=True)})
    shown, real = made.observe(), made.truth()
    assert real.own[0].ball_contact
    assert math.hypot(shown.ball.x - real.ball.x, shown.ball.y - real.ball.y) < 0.01
    late = made.world.observe()
    assert math.hypot(late.ball.x - real.ball.x, late.ball.y - real.ball.y) > 0.03


@pytest.mark.parametrize("command", [RobotCommand(-1.0), RobotCommand(omega=3.0)])
def test_a_ball_that_two_robots_hold_goes_between_them(command: RobotCommand) -> None:
    late = RealismSettings(vision_delay=0.035)
    sim = SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, preset("grsim", realism=late), PERIOD)
    made = PredictedWorld(sim, late.vision_delay)
    start = {BLUE: (-0.1021, 0.0, 0.0), YELLOW: (0.1021, 0.0, math.pi)}
    made.reset(Placement(start, (0.0, 0.0, 0.0, 0.0)), 1)
    for _ in range(9):
        shown, real = made.observe(), made.truth()
        assert [robot.ball_contact for robot in real.own + real.opponents] == [True, True]
        assert math.hypot(shown.ball.vx - real.ball.vx, shown.ball.vy - real.ball.vy) < 0.12
        assert math.hypot(shown.ball.x - real.ball.x, shown.ball.y - real.ball.y) < 0.006
        made.act({BLUE: replace(command, dribbler=True), YELLOW: RobotCommand(dribbler=True)})


@pytest.mark.parametrize("delay", [0.035, 0.1])
def test_they_may_begin_as_they_drive(delay: float) -> None:
    late = RealismSettings(vision_delay=delay)
    sim = SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, preset("grsim", realism=late), PERIOD)
    made = PredictedWorld(sim, delay)
    start = {BLUE: (-0.1015, 0.0, 0.0), YELLOW: (0.1015, 0.0, math.pi)}
    made.reset(Placement(start, (0.0, 0.0, 2.0, 0.0), {BLUE: (2.0, 0.0), YELLOW: (2.0, 0.0)}), 1)
    for _ in range(7):
        shown = made.observe()
        assert shown.ball.x - shown.own[0].x == pytest.approx(0.1015, abs=0.005)
        made.act({BLUE: RobotCommand(2.0, dribbler=True), YELLOW: RobotCommand(-2.0, dribbler=True)})


def test_a_ball_that_was_not_yet_in_their_mouths_when_it_was_seen_is_there_now() -> None:
    late = RealismSettings(vision_delay=0.1)
    sim = SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, preset("grsim", realism=late), PERIOD)
    made = PredictedWorld(sim, late.vision_delay)
    # Two mouths that wait for it, half turned to each other.
    x, y, turn = 0.0663, 0.0978, math.radians(50.0)
    start = {BLUE: (x, y, turn - math.pi), YELLOW: (x, -y, math.pi - turn)}
    made.reset(Placement(start, (-0.25, 0.0, 3.0, 0.0)), 1)
    held = 0
    for _ in range(20):
        shown, real = made.observe(), made.truth()
        if all(robot.ball_contact for robot in real.own + real.opponents):
            held += 1
            assert math.hypot(shown.ball.x - real.ball.x, shown.ball.y - real.ball.y) < 0.05
        made.act({BLUE: RobotCommand(dribbler=True), YELLOW: RobotCommand(dribbler=True)})
    assert held > 5


def test_a_detection_that_is_missing_is_bridged() -> None:
    made = world(vision_delay=0.03, missing_robot=0.5)
    worst = 0.0
    for _ in range(40):
        made.act({BLUE: RobotCommand(2.0), YELLOW: RobotCommand(2.0)})
        shown = made.observe()
        worst = max(worst, off(shown, made.truth()))
    assert worst < 0.25
    bridged = world(vision_delay=0.03, missing_robot=0.5)
    bridged._gaps = False
    unbridged = 0.0
    for _ in range(40):
        bridged.act({BLUE: RobotCommand(2.0), YELLOW: RobotCommand(2.0)})
        unbridged = max(unbridged, off(bridged.observe(), bridged.truth()))
    assert worst < unbridged


def test_a_ball_is_shown_outside_of_robots() -> None:
    made = world(ball=(-0.85, 0.082), vision_delay=0.09)
    for _ in range(6):
        made.act({BLUE: RobotCommand(1.0)})
        shown = made.observe()
        robot = shown.own[0]
        assert math.hypot(shown.ball.x - robot.x, shown.ball.y - robot.y) > 0.09


def test_a_reset_forgets_what_was_sent() -> None:
    made = world(vision_delay=0.05)
    drive(made, 5, RobotCommand(3.0))
    made.reset(Placement({BLUE: (0.0, 0.0, 0.0), YELLOW: (1.0, 1.0, 0.0)}, (2.0, 2.0, 0.0, 0.0)), 1)
    assert off(made.observe(), made.truth()) == 0.0


def test_a_ball_in_the_air_is_shown_as_high_as_it_is() -> None:
    # It goes on from where it was seen at the end of a tick: what is late by whole ticks is exact.
    made = world(vision_delay=PERIOD)
    gap = preset("rsim").body.face + BALL_RADIUS
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (4.0, 1.0, -2.0)}, (gap - 1.0, 0.0, 0.0, 0.0)), 1)
    made.observe()
    made.act({BLUE: RobotCommand(kick_speed=5.0, kick_angle=CHIP_ANGLE)})
    for _ in range(12):
        made.act({})
        shown, real = made.observe().ball, made.truth().ball
        assert (shown.z, shown.vz) == pytest.approx((real.z, real.vz), abs=1e-6)
        assert shown.x == pytest.approx(real.x, abs=1e-6)
    assert real.z > 0.4


@pytest.mark.parametrize(
    "answer",
    [
        {"dead_time": 0.09},
        {"lag": 0.04, "side_lag": 0.05, "turn_lag": 0.03},
        {"gain": 0.76, "side_gain": 0.64, "turn_gain": 0.9, "cross_ahead": -0.05},
        {
            "dead_time": 0.117,
            "lag": 0.037,
            "side_lag": 0.038,
            "turn_lag": 0.03,
            "gain": 0.94,
            "side_gain": 0.57,
        },
    ],
)
@pytest.mark.parametrize("vision", [0.0, 0.035])
def test_robots_are_shown_where_their_next_command_finds_them(
    answer: dict[str, float], vision: float
) -> None:
    late = RealismSettings(vision_delay=vision)
    settings = preset("rsim", realism=late)
    limits = settings.limits.model_copy(update=answer)
    sim = SimWorld(DIVISION_B, {BLUE: limits, YELLOW: limits}, settings, 0.01)
    made = PredictedWorld(sim, vision)
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.5), YELLOW: (1.0, 1.0, -2.0)}, (3.0, 2.0, 0.0, 0.0)), 1)
    shown = {}
    for tick in range(90):
        frame = made.observe()
        shown[tick] = frame
        then = tick - round(limits.dead_time / 0.01)
        if then >= 0:
            assert off(shown[then], made.truth()) < 0.012
        going = RobotCommand(1.5, 0.6, 2.0) if tick < 40 else RobotCommand(-0.5, -0.8, -1.0)
        made.act({BLUE: going, YELLOW: going})


def late_field(**limits: float) -> PredictedWorld:
    """A field whose robots obey 0.1 s late; the ball's model is simple enough to be predicted."""
    settings = preset("rsim")
    late = settings.limits.model_copy(update={"dead_time": 0.1, "catch_speed": 5.0, **limits})
    return PredictedWorld(SimWorld(DIVISION_B, {BLUE: late, YELLOW: late}, settings, 0.01), 0.0)


def follow(made: PredictedWorld, ticks: int, kick_at: int) -> list[tuple[Frame, Frame]]:
    """What was shown of every moment 0.1 s before, and what was."""
    shown: list[Frame] = []
    pairs = []
    for tick in range(ticks):
        shown.append(made.observe())
        if tick >= 10:
            pairs.append((shown[tick - 10], made.truth()))
        kick = 4.0 if kick_at <= tick < kick_at + 10 else 0.0
        made.act({BLUE: RobotCommand(kick_speed=kick, dribbler=True), YELLOW: RobotCommand()})
    return pairs


def test_a_carried_ball_leaves_with_the_kick_that_is_on_its_way() -> None:
    made = late_field()
    gap = preset("rsim").body.face + BALL_RADIUS
    ball = (-1.0 + gap * math.cos(0.6), gap * math.sin(0.6))
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.6), YELLOW: (3.0, 2.0, 0.0)}, (*ball, 0.0, 0.0)), 1)
    pairs = follow(made, 45, kick_at=10)
    assert pairs[-1][1].ball.speed > 2.5
    for shown, real in pairs:
        assert math.hypot(shown.ball.x - real.ball.x, shown.ball.y - real.ball.y) < 0.15
    told = [shown.own[0].ball_contact for shown, _ in pairs]
    was = [real.own[0].ball_contact for _, real in pairs]
    assert abs(told.index(False) - was.index(False)) <= 4


@pytest.mark.parametrize("kick_at", [15, 99])
def test_a_rolling_ball_is_met_by_the_robot_in_its_way(kick_at: int) -> None:
    made = late_field()
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (3.0, 2.0, 0.0)}, (0.0, 0.0, -3.0, 0.0)), 1)
    pairs = follow(made, 45, kick_at)
    for shown, real in pairs[:-3]:
        assert shown.ball.x > -0.95
        assert math.hypot(shown.ball.x - real.ball.x, shown.ball.y - real.ball.y) < 0.17
    assert (pairs[-1][0].ball.vx > 2.0) is (kick_at < 99)


def test_a_ball_is_taken_no_earlier_than_it_comes() -> None:
    """Slow enough that no step passes over the last millimetres before the mouth."""
    made = late_field()
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (3.0, 2.0, 0.0)}, (-0.82, 0.0, -0.6, 0.0)), 1)
    for shown, _ in follow(made, 45, kick_at=99):
        if shown.own[0].ball_contact:
            break
        nearest = shown.ball.x
    assert nearest < -1.0 + PLACE + 0.004


def test_a_ball_too_fast_to_be_taken_bounces_off() -> None:
    made = late_field(catch_speed=0.5)
    made.reset(Placement({BLUE: (-1.0, 0.0, math.pi), YELLOW: (3.0, 2.0, 0.0)}, (0.0, 0.0, -3.0, 0.0)), 1)
    pairs = follow(made, 45, kick_at=99)
    for shown, _ in pairs:
        assert shown.ball.x > -1.0
    assert 0.2 < pairs[-1][0].ball.vx < 2.0


def test_a_kick_on_its_way_to_another_robot_is_caught_by_that_one() -> None:
    made = late_field()
    gap = preset("rsim").body.face + BALL_RADIUS
    poses = {BLUE: (-1.0, 0.0, 0.0), YELLOW: (-0.65, 0.0, math.pi)}
    made.reset(Placement(poses, (gap - 1.0, 0.0, 0.0, 0.0)), 1)
    foreseen = []
    for tick in range(30):
        shown, real = made.observe(), made.truth()
        if real.own[0].ball_contact and shown.opponents[0].ball_contact:
            foreseen.append(shown)
        kick = 3.0 if tick >= 10 else 0.0
        made.act({BLUE: RobotCommand(kick_speed=kick, dribbler=True), YELLOW: RobotCommand(dribbler=True)})
    assert foreseen
    for shown in foreseen:
        assert not shown.own[0].ball_contact
        assert shown.last_touch == YELLOW
        assert shown.ball.x == pytest.approx(-0.65 - gap, abs=0.02)


@pytest.mark.parametrize("name", ["default", "grsim", "rsim", "erforce"])
def test_a_ball_that_has_been_kicked_is_shown_so_before_cameras_see_it(name: str) -> None:
    realism = RealismSettings(vision_delay=0.05, command_delay=0.05, ball_noise=0.001, robot_noise=0.001)
    settings = preset(name, realism=realism)
    sim = SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, settings, 0.01)
    made = PredictedWorld(sim, realism.vision_delay, realism.command_delay)
    ball = settings.body.face + BALL_RADIUS - 1.0
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (3.0, 2.0, 0.0)}, (ball, 0.0, 0.0, 0.0)), 1)
    kicked = 0
    for tick in range(60):
        shown, real = made.observe(), made.truth()
        if real.ball.speed > 2.0:
            kicked += 1
            assert shown.ball.vx > 1.0
        kick = 4.0 if tick > 30 else 0.0
        made.act({BLUE: RobotCommand(vx=0.3, kick_speed=kick, dribbler=True), YELLOW: RobotCommand()})
    assert kicked > 10


def test_a_kick_of_a_moment_ago_does_not_hide_who_has_touched_the_ball_since() -> None:
    realism = RealismSettings(vision_delay=0.1)
    settings = preset("rsim", realism=realism)
    made = PredictedWorld(SimWorld(DIVISION_B, {BLUE: None, YELLOW: None}, settings, 0.01), 0.1)
    gap = settings.body.face + BALL_RADIUS
    # It shows the ball its back.
    poses = {BLUE: (-1.0, 0.0, 0.0), YELLOW: (-0.65, 0.0, 0.0)}
    made.reset(Placement(poses, (gap - 1.0, 0.0, 0.0, 0.0)), 1)
    touched = set()
    for tick in range(50):
        shown, real = made.observe(), made.truth()
        if real.last_touch == YELLOW and not real.own[0].ball_contact:
            touched.add(shown.last_touch)
        kick = 4.0 if 10 <= tick < 25 else 0.0
        made.act({BLUE: RobotCommand(kick_speed=kick, dribbler=True), YELLOW: RobotCommand()})
    assert touched == {YELLOW}


@pytest.mark.parametrize(("speed", "angle"), [(0.5, 0.0), (1.5, 1.2)])
def test_a_weak_or_steep_kick_on_its_way_is_one_kick(speed: float, angle: float) -> None:
    made = late_field(kick_carried=0.9)
    gap = preset("rsim").body.face + BALL_RADIUS
    made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (3.0, 2.0, 0.0)}, (gap - 1.0, 0.0, 0.0, 0.0)), 1)
    for tick in range(25):
        assert made.observe().ball.vx < speed * math.cos(angle) + 1e-9
        kick = speed if tick >= 10 else 0.0
        command = RobotCommand(kick_speed=kick, dribbler=True, kick_angle=angle)
        made.act({BLUE: command, YELLOW: RobotCommand()})


@pytest.mark.parametrize("response_loss", [0.0, 0.9])
def test_a_ball_is_shown_alike_by_known_delays_and_by_those_expected(response_loss: float) -> None:
    # A robot whose sensor tells nothing has not taken the ball until now.
    realism = RealismSettings(vision_delay=0.05, command_delay=0.052, response_loss=response_loss)
    settings = preset("rsim", realism=realism)
    limits = settings.limits.model_copy(update={"catch_speed": 5.0})

    def shown(measured: bool) -> list[tuple[float, float, bool]]:
        sim = SimWorld(DIVISION_B, {BLUE: limits, YELLOW: limits}, settings, 0.01)
        made = PredictedWorld(sim, realism.vision_delay, realism.command_delay)
        if measured:
            made = MeasuredWorld(sim, DelayWatch(limits, nominal=realism.command_delay))
        made.reset(Placement({BLUE: (-1.0, 0.0, 0.0), YELLOW: (3.0, 2.0, 0.0)}, (0.0, 0.0, -3.0, 0.0)), 1)
        found = []
        for tick in range(80):
            frame = made.observe()
            found.append((frame.ball.x, frame.ball.vx, frame.own[0].ball_contact))
            kick = 4.0 if tick > 50 else 0.0
            made.act({BLUE: RobotCommand(kick_speed=kick, dribbler=True), YELLOW: RobotCommand()})
        return found

    known, expected = shown(measured=False), shown(measured=True)
    assert {has for *_, has in known} == {False, True}
    assert np.allclose(known, expected, atol=1e-6)
