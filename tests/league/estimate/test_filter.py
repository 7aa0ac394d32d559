"""The filter: steady where nothing happens, quick where something does, and never at a loss."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, inf, pi, sin, sqrt

import numpy as np
import pytest

from benchmarks.filter import Rms, bench_filter
from robobt.league.estimate.ball_track import BallMotion, predict_ball
from robobt.league.estimate.filter import VisionFilter
from robobt.league.estimate.robot_track import RobotMotion, Sent, predict_robot
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.match import load_scenario
from robobt.match.scenario.changes import with_team
from robobt.sim.realism import REALISM
from robobt.sim.settings import BallSettings, SimSettings
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotId

PERIOD = 1 / 60
ME, HER = RobotId(Team.BLUE, 2), RobotId(Team.YELLOW, 7)
REALISTIC = SimSettings(realism=REALISM["realistic"])
WHITE = REALISM["realistic"].model_copy(update={"object_offset": 0.0, "camera_error": 0.0})
"""Noise and gaps without the systematic errors, which no filter can take out."""


class Watched:
    """A filter fed with frames of one camera, 60 a second."""

    def __init__(self, noise: float = 0.0, camera: int = 0) -> None:
        self.filter = VisionFilter(DIVISION_B, REALISTIC)
        self.rng = np.random.default_rng(1)
        self.noise, self.camera, self.number = noise, camera, 0
        self.time = 100.0

    def see(
        self,
        robots: list[tuple[RobotId, float, float, float]] | None = None,
        balls: list[tuple[float, float]] | None = None,
        confidence: float = 1.0,
    ) -> None:
        def spoilt(value: float) -> float:
            return value + self.noise * float(self.rng.standard_normal())

        self.number += 1
        self.time += PERIOD
        self.filter.add(
            CameraFrame(
                self.camera,
                self.number,
                self.time,
                self.time,
                [BallDetection(spoilt(x), spoilt(y), confidence) for x, y in balls or []],
                [
                    RobotDetection(r, spoilt(x), spoilt(y), wrap_angle(h), confidence)
                    for r, x, y, h in robots or []
                ],
            )
        )

    def see_for(
        self,
        seconds: float,
        robot: Callable[[float], tuple[float, float, float]] | None = None,
        ball: Callable[[float], tuple[float, float]] | None = None,
    ) -> None:
        began = self.time
        while self.time < began + seconds:
            t = self.time + PERIOD - began
            self.see([] if robot is None else [(ME, *robot(t))], [] if ball is None else [ball(t)])

    def frame(self, ahead: float = 0.0) -> Frame:
        return self.filter.frame_at(self.time + ahead)


@pytest.fixture
def watched() -> Watched:
    return Watched()


@pytest.fixture(scope="module", params=[1, 4], ids=["one camera", "four cameras"])
def measured(request: pytest.FixtureRequest) -> dict[str, Rms]:
    # Without chips: one camera cannot tell where a ball in the air is before it has seen some of its way.
    scenario = load_scenario("six_v_six")
    for team in Team:
        scenario = with_team(scenario, team, None, {"chips": False})
    return bench_filter(scenario, seconds=9.0, seed=2, realism=WHITE, cameras=request.param)


@pytest.mark.integration
def test_at_constant_velocity_the_errors_are_within_the_bars(measured: dict[str, Rms]) -> None:
    figures = measured["constant_velocity"]["at_capture"]
    noise = REALISM["realistic"]
    # The figures are errors in the plane, the noise is that of an axis.
    assert figures["robot_position"] / sqrt(2) <= noise.robot_noise / 2
    assert figures["ball_position"] / sqrt(2) <= noise.ball_noise / 2
    assert figures["robot_velocity"] <= 0.10
    assert figures["ball_velocity"] <= 0.15
    assert figures["robot_heading"] <= noise.heading_noise / 2
    assert figures["missing_robots"] == 0.0


@pytest.mark.integration
def test_in_a_match_prediction_with_the_sent_commands_beats_none(measured: dict[str, Rms]) -> None:
    play = measured["play"]
    for figure in ("robot_position", "robot_heading", "robot_velocity", "robot_turn", "ball_position"):
        assert play["compensated"][figure] < play["uncompensated"][figure] * 0.75
    assert play["at_capture"]["robot_position"] < 0.003
    assert play["compensated"]["missing_robots"] == 0.0


def test_the_same_detections_give_the_same_frames() -> None:
    frames = []
    for _ in range(2):
        watched = Watched(noise=0.002)
        watched.see_for(0.5, lambda t: (t, 0.0, 0.0), lambda t: (0.0, t))
        frames.append(watched.frame(0.03))
    assert frames[0] == frames[1]


def test_a_command_that_was_sent_is_predicted_with_before_it_is_seen(watched: Watched) -> None:
    watched.see_for(0.5, lambda _: (0.0, 0.0, pi / 2))
    watched.filter.sent(watched.time, {ME: RobotCommand(2.0, 0.0, 1.0)})
    (robot,) = watched.frame(0.1).own
    # 3 m/s^2 along the heading, which is +y here.
    assert robot.vy == pytest.approx(0.3, abs=0.02)
    assert robot.y == pytest.approx(0.015, abs=0.003)
    assert robot.omega == pytest.approx(1.0, abs=0.05)


def test_a_turn_through_half_a_circle_has_no_seam(watched: Watched) -> None:
    for t in np.arange(0.0, 3.0, PERIOD):
        heading = wrap_angle(3.0 * t)
        watched.see([(ME, 0.0, 0.0, heading)])
        if t > 0.5:
            (robot,) = watched.frame().own
            assert abs(wrap_angle(robot.heading - heading)) < 0.03
            assert robot.omega == pytest.approx(3.0, abs=0.3)


def test_missing_detections_are_bridged(watched: Watched) -> None:
    watched.see_for(0.5, lambda t: (t, 0.0, 0.0), lambda t: (-t, 1.0))
    for _ in range(6):
        watched.see()
    frame = watched.frame()
    assert frame.own[0].x == pytest.approx(0.6, abs=0.02)
    assert frame.ball.x == pytest.approx(-0.6, abs=0.03)


def test_a_robot_that_has_left_is_gone_after_a_second(watched: Watched) -> None:
    watched.see_for(0.5, lambda _: (0.0, 0.0, 0.0))
    for _ in range(50):
        watched.see()
    assert watched.filter.robots() == [ME]
    for _ in range(15):
        watched.see()
    assert watched.filter.robots() == []


def test_a_robot_seen_once_is_no_robot(watched: Watched) -> None:
    watched.see([(ME, 0.0, 0.0, 0.0)])
    for _ in range(5):
        watched.see([(HER, 1.0, 0.0, 0.0)])
    assert watched.filter.robots() == [HER]


def test_of_two_robots_with_one_number_the_nearer_to_where_it_was_is_meant(watched: Watched) -> None:
    watched.see_for(0.5, lambda _: (0.0, 0.0, 0.0))
    for _ in range(20):
        watched.see([(ME, 2.0, 1.0, 1.0), (ME, 0.0, 0.0, 0.0)])
    (robot,) = watched.frame().own
    assert robot.position == (pytest.approx(0.0, abs=1e-3), pytest.approx(0.0, abs=1e-3))


def test_detections_of_no_confidence_are_left_out(watched: Watched) -> None:
    for _ in range(10):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(1.0, 1.0)], confidence=0.05)
    assert watched.filter.robots() == []
    assert watched.filter.ball_unseen() == inf


def test_a_false_ball_is_ignored_and_a_real_one_believed_after_three_frames(watched: Watched) -> None:
    watched.see_for(0.5, ball=lambda _: (0.0, 0.0))
    watched.see(balls=[(3.0, 2.0)])
    assert watched.frame().ball.x == pytest.approx(0.0, abs=1e-3)
    for _ in range(3):
        watched.see(balls=[(3.0, 2.0)])
    assert watched.frame().ball.position == (3.0, 2.0)


def test_of_two_balls_the_one_in_play_is_followed(watched: Watched) -> None:
    watched.see_for(0.5, ball=lambda t: (t, 0.0))
    for i in range(30):
        watched.see(balls=[(-2.0, -2.0), (0.5 + (i + 1) * PERIOD, 0.0)])
    assert watched.frame().ball.x == pytest.approx(1.0, abs=0.02)


def test_a_robot_that_is_carried_elsewhere_is_found_there_at_rest(watched: Watched) -> None:
    watched.see_for(0.5, lambda t: (t, 0.0, 0.0))
    watched.see_for(0.3, lambda _: (-3.0, 2.0, 1.0))
    (robot,) = watched.frame().own
    assert robot.position == (pytest.approx(-3.0, abs=0.01), pytest.approx(2.0, abs=0.01))
    assert robot.speed < 0.05


def test_a_kick_is_noticed_within_three_frames(watched: Watched) -> None:
    watched.see_for(0.5, ball=lambda _: (0.0, 0.0))
    watched.see_for(3 * PERIOD, ball=lambda t: (6.0 * t, 0.0))
    ball = watched.frame().ball
    assert ball.vx == pytest.approx(6.0, rel=0.1)
    assert ball.x == pytest.approx(6.0 * 3 * PERIOD, abs=0.02)


def test_the_speed_of_a_kick_is_known_from_the_first_sight_of_it(watched: Watched) -> None:
    for _ in range(30):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(0.11, 0.0)])
    watched.see([(ME, 0.0, 0.0, 0.0)], [(0.11 + 6.0 * PERIOD, 0.0)])
    assert watched.frame().ball.vx == pytest.approx(6.0, abs=0.3)
    assert watched.frame().ball.vy == pytest.approx(0.0, abs=0.1)


def test_a_ball_that_jumps_where_no_robot_is_has_not_been_kicked(watched: Watched) -> None:
    for _ in range(30):
        watched.see([(ME, -2.0, 0.0, 0.0)], [(0.11, 0.0)])
    watched.see([(ME, -2.0, 0.0, 0.0)], [(0.16, 0.0)])
    assert watched.frame().ball.speed < 0.1


def test_cameras_that_disagree_about_a_ball_in_the_mouth_kick_nothing(watched: Watched) -> None:
    for i in range(60):
        watched.camera = i // 30
        watched.see([(ME, 0.0, 0.0, 0.0)], [(0.11 + 0.02 * watched.camera, 0.0)])
        assert watched.frame().ball.speed < 0.1


def test_a_commanded_velocity_turns_with_the_robot(watched: Watched) -> None:
    speed, turn = 1.0, 2.0
    circle = speed / turn

    def driven(t: float) -> tuple[float, float, float]:
        return circle * sin(turn * t), circle * (1.0 - cos(turn * t)), wrap_angle(turn * t)

    watched.filter.sent(watched.time, {ME: RobotCommand(speed, 0.0, turn)})
    watched.see_for(1.0, driven)
    (me,) = watched.frame(0.1).own
    assert hypot(me.vx - speed * cos(me.heading), me.vy - speed * sin(me.heading)) < 0.015


def test_a_kicked_ball_is_predicted_to_slide_and_then_to_roll() -> None:
    watched = Watched(noise=0.0014)
    settings = REALISTIC.ball
    start = BallMotion(-4.0, 0.0)
    kicked = BallMotion(-4.0, 0.0, 4.0, 0.0, settings.switch_share * 4.0)

    def place(t: float) -> tuple[float, float]:
        motion = start if t < 0.3 else predict_ball(kicked, t - 0.3, settings)
        return motion.x, motion.y

    began = watched.time
    watched.see_for(0.6, ball=place)
    for ahead in (0.0, 0.05, 0.2, 0.6):
        real = predict_ball(kicked, watched.time - began - 0.3 + ahead, settings)
        seen = watched.frame(ahead).ball
        assert (seen.x, seen.vx) == (pytest.approx(real.x, abs=0.02), pytest.approx(real.vx, abs=0.05))


def test_a_hidden_ball_goes_with_the_robot_that_has_it(watched: Watched) -> None:
    mouth = REALISTIC.body.face + 0.0215

    def robot(t: float) -> tuple[float, float, float]:
        return (0.5 * t, 0.0, 0.4 * t)

    def ball(t: float) -> tuple[float, float]:
        x, y, heading = robot(t)
        return (x + mouth * cos(heading), y + mouth * sin(heading))

    watched.see_for(1.0, robot, ball)
    began = watched.time - 1.0
    for _ in range(60):
        watched.see([(ME, *robot(watched.time + PERIOD - began))])
    frame = watched.frame()
    x, y = ball(watched.time - began)
    assert hypot(frame.ball.x - x, frame.ball.y - y) < 0.02
    assert frame.own[0].ball_contact
    assert watched.filter.ball_unseen() == pytest.approx(1.0, abs=0.02)


def test_a_ball_that_two_robots_hold_goes_between_them(watched: Watched) -> None:
    mouth = REALISTIC.body.face + 0.0215
    for _ in range(30):
        watched.see([(ME, -mouth, 0.0, 0.0), (HER, mouth, 0.0, pi)], [(0.0, 0.0)])
    watched.filter.sent(watched.time, {HER: RobotCommand(-1.0)})
    frame = watched.frame(0.05)
    me, her = frame.own[0], frame.opponents[0]
    assert me.ball_contact
    assert her.ball_contact
    assert her.vx - me.vx > 0.1
    assert frame.ball.vx == pytest.approx((me.vx + her.vx) / 2, abs=0.01)
    assert frame.ball.x == pytest.approx((me.x + her.x) / 2, abs=0.001)


@pytest.mark.parametrize("reported", [None, ME, HER])
def test_a_hidden_ball_stays_with_one_of_two_that_part(watched: Watched, reported: RobotId | None) -> None:
    mouth = REALISTIC.body.face + 0.0215
    for _ in range(30):
        watched.see([(ME, -mouth, 0.0, 0.0), (HER, mouth, 0.0, pi)], [(0.0, 0.0)])
    if reported is not None:
        watched.filter.possession.feedback.update({ME: reported == ME, HER: reported == HER})
    for i in range(60):
        watched.see([(ME, -mouth, 0.0, 0.0), (HER, mouth + 0.8 * i * PERIOD, 0.0, pi)])
    frame = watched.frame()
    me, her = frame.own[0], frame.opponents[0]
    assert (me.ball_contact, her.ball_contact) == (reported != HER, reported == HER)
    assert frame.ball.x == pytest.approx(her.x - mouth if reported == HER else 0.0, abs=0.02)


def test_a_hidden_ball_is_in_the_mouth_whose_sensor_reports_it(watched: Watched) -> None:
    mouth = REALISTIC.body.face + 0.0215
    watched.see_for(0.3, lambda _: (-0.4, 0.0, 0.0), lambda _: (0.0, 0.0))
    # It drives on to the ball, which it hides, and pushes it on.
    watched.see_for(0.5, lambda t: (-0.4 + 0.8 * t, 0.0, 0.0))
    watched.filter.possession.feedback[ME] = True
    watched.see_for(0.3, lambda t: (0.8 * t, 0.0, 0.0))
    frame = watched.frame()
    assert frame.own[0].ball_contact
    assert frame.ball.x - frame.own[0].x == pytest.approx(mouth, abs=0.01)
    assert frame.ball.vx == pytest.approx(0.8, abs=0.05)
    # It loses it there, and backs away.
    watched.filter.possession.feedback[ME] = False
    watched.see_for(0.3, lambda t: (0.24 - 0.5 * t, 0.0, 0.0))
    frame = watched.frame()
    assert not frame.own[0].ball_contact
    assert frame.ball.x > 0.24 + mouth - 0.02


def test_a_hidden_ball_that_is_lost_stays_where_the_robot_lost_it(watched: Watched) -> None:
    mouth = REALISTIC.body.face + 0.0215
    watched.filter.possession.feedback[ME] = True
    watched.see_for(0.3, lambda t: (t, 0.0, 0.0), lambda t: (t + mouth, 0.0))
    watched.see_for(0.6, lambda t: (0.3 + t, 0.0, 0.0))
    watched.filter.possession.feedback[ME] = False
    watched.see_for(0.1, lambda t: (0.9 - t, 0.0, 0.0))
    frame = watched.frame()
    assert not frame.own[0].ball_contact
    assert frame.ball.x == pytest.approx(0.9 + mouth + 0.1, abs=0.05)


def test_a_speed_too_small_to_divide_by_is_predicted() -> None:
    still = RobotMotion(0.0, 0.0, 0.0, 5e-324, 0.0, 0.0)
    assert predict_robot(still, 0.0, 0.1, [Sent(0.0, RobotCommand())], RobotLimits()).vx == pytest.approx(0.0)


def test_no_robot_stands_on_a_hidden_ball(watched: Watched) -> None:
    watched.see_for(0.3, lambda _: (-0.4, 0.02, 0.0), lambda _: (0.0, 0.0))
    watched.see_for(0.8, lambda t: (-0.4 + 0.8 * t, 0.02, 0.0))
    frame = watched.frame()
    ahead = frame.ball.x - frame.own[0].x
    assert ahead >= REALISTIC.body.face + 0.0215 - 0.011


def test_a_hidden_ball_that_nobody_has_rolls_on_to_rest(watched: Watched) -> None:
    watched.see_for(0.5, ball=lambda t: (0.4 * t, 0.0))
    for _ in range(120):
        watched.see()
    frame = watched.frame()
    assert frame.ball.speed == 0.0
    assert 0.2 < frame.ball.x < 0.6


def test_a_prediction_ends_at_the_robot_in_the_way(watched: Watched) -> None:
    for i in range(30):
        watched.see([(HER, 1.0, 0.0, pi)], [(-1.0 + 3.0 * i * PERIOD, 0.0)])
    assert watched.frame(0.3).ball.x == pytest.approx(1.0 - 0.09 - 0.0215, abs=0.01)


def test_a_robots_own_sensor_decides_who_has_the_ball(watched: Watched) -> None:
    for _ in range(30):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(0.1, 0.0)])
    assert watched.frame().own[0].ball_contact
    assert watched.frame().last_touch == ME
    watched.filter.possession.feedback[ME] = False
    assert not watched.frame().own[0].ball_contact
    watched.filter.possession.feedback[ME] = True
    for _ in range(30):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(0.5, 0.0)])
    assert not watched.frame().own[0].ball_contact


def test_cameras_that_overlap_agree_on_one_robot() -> None:
    filter_ = VisionFilter(DIVISION_B, REALISTIC)
    for i in range(60):
        time = i * PERIOD
        for camera, late in ((0, 0.0), (1, 0.002)):
            x = 1.0 * (time - late)
            seen = [RobotDetection(ME, x, 0.0, 0.0)]
            filter_.add(CameraFrame(camera, i, time - late, time, [BallDetection(x, 1.0)], seen))
    frame = filter_.frame_at(59 * PERIOD)
    assert len(frame.own) == 1
    assert frame.own[0].x == pytest.approx(59 * PERIOD, abs=0.003)
    assert frame.own[0].vx == pytest.approx(1.0, abs=0.05)


def test_repeated_and_late_frames_change_nothing(watched: Watched) -> None:
    watched.see_for(0.5, lambda t: (t, 0.0, 0.0))
    before = watched.frame()
    old = CameraFrame(0, 3, watched.time - 0.1, watched.time, [], [RobotDetection(ME, -1.0, 0.0, 0.0)])
    assert not watched.filter.add(old)
    assert watched.frame() == before


def test_a_source_that_starts_anew_is_followed_from_there(watched: Watched) -> None:
    watched.see_for(0.5, lambda _: (1.0, 0.0, 0.0))
    watched.time = 0.0
    watched.see_for(0.2, lambda _: (-2.0, 0.0, 0.0))
    assert watched.filter.captured == pytest.approx(0.2, abs=PERIOD)
    assert watched.frame().own[0].x == pytest.approx(-2.0, abs=1e-3)


@pytest.mark.parametrize("speed", [0.5, 2.0, 6.5])
def test_the_balls_closed_form_is_that_of_its_two_phases(speed: float) -> None:
    settings = BallSettings()
    motion = BallMotion(0.0, 0.0, speed, 0.0, settings.switch_share * speed)
    t_slide = speed * (1 - settings.switch_share) / settings.slide_deceleration
    v_roll = settings.switch_share * speed
    total = (speed + v_roll) / 2 * t_slide + v_roll**2 / (2 * settings.roll_deceleration)
    end = predict_ball(motion, 1000.0, settings)
    assert (end.x, end.vx) == (pytest.approx(total), 0.0)
    halves = predict_ball(predict_ball(motion, 0.3, settings), 0.4, settings)
    assert halves.x == pytest.approx(predict_ball(motion, 0.7, settings).x)


def test_what_cameras_report_and_how_sure_the_filter_is_can_be_drawn() -> None:
    watched, sketch = Watched(), Sketch()
    sketch.want({"detections", "covariance"}, set())
    for _ in range(10):
        watched.see([(ME, 1.0, 0.5, 0.0)], [(-1.0, 0.25)])
    watched.filter.draw(sketch)
    shapes = sketch.take()
    assert ["detections", "point", 1.0, 0.5] in shapes
    assert ["detections", "point", -1.0, 0.25] in shapes
    circles = [shape for shape in shapes if shape[0] == "covariance"]
    assert len(circles) == 2
    assert all(0.0 < radius < 0.05 for *_, radius in circles)


@pytest.mark.parametrize("speed", [0.0, 4.0])
def test_a_kick_on_its_way_is_shown(speed: float) -> None:
    watched = Watched()
    watched.filter = VisionFilter(DIVISION_B, SimSettings(), {ME: RobotLimits(dead_time=0.1)})
    gap = SimSettings().body.face + 0.0215
    for tick in range(30):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(gap, 0.0)])
        kick = speed if tick >= 28 else 0.0
        watched.filter.sent(watched.time, {ME: RobotCommand(kick_speed=kick, dribbler=True)})
    shown = watched.filter.frame_at(watched.time + 2 * PERIOD, to_effect=True)
    assert shown.own[0].ball_contact is (speed == 0.0)
    assert shown.ball.vx == pytest.approx(speed, abs=0.5)
    # It leaves 0.1 s after the first command to kick, and is shown 0.1 s after two more periods.
    assert shown.ball.x - gap == pytest.approx(speed * 3 * PERIOD, abs=0.03)
    assert shown.last_touch == ME
    assert watched.filter.frame_at(watched.time).own[0].ball_contact


@pytest.mark.parametrize("trigger", list(KickTrigger))
@pytest.mark.parametrize("reported", [True, False])
def test_a_kick_at_once_is_not_shown_where_the_sensor_is_silent(trigger: KickTrigger, reported: bool) -> None:
    watched = Watched()
    watched.filter = VisionFilter(DIVISION_B, SimSettings(), {ME: RobotLimits(dead_time=0.1)})
    for tick in range(30):
        watched.see([(ME, 0.0, 0.0, 0.0)], [(SimSettings().body.face + 0.0215, 0.0)])
        kick = RobotCommand(kick_speed=4.0 if tick >= 28 else 0.0, kick_trigger=trigger)
        watched.filter.sent(watched.time, {ME: kick})
    watched.filter.possession.hear([(ME, reported)], watched.time)
    shown = watched.filter.frame_at(watched.time + 2 * PERIOD, to_effect=True)
    missed = trigger is KickTrigger.NOW and not reported
    assert shown.ball.vx == pytest.approx(0.0 if missed else 4.0, abs=0.5)
