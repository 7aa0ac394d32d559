"""The vision filter where vision is at fault: the largest error of each case, and cameras that disagree.

    python -m benchmarks vision_faults
    python -m benchmarks vision_faults --draws 1000

The first form plays each fault for six seconds and prints the largest errors after the first second. Our
robot drives in circles at 1 m/s and turns with them, without telling the filter its commands; another
stands; the ball rolls along the field. Detections have the noise and gaps of *realistic*.

The second draws scenes in which two to four cameras see everything, each with an offset of 0 to 5 cm in a
direction of its own, their frames up to 1/60 s apart. It prints the largest errors of speed in all draws,
beside those of one camera: of a ball and a robot at rest, and of both moving steadily at 0.5 to 3 m/s, where
the filter expects the ball to slow down. In further draws a robot pushes the ball along, or has it 3 cm
before its mouth, or the ball rolls into the goal. It prints in how many draws the filter is ever wrong about
who has the ball, or who scores.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from math import cos, hypot, pi, sin

import numpy as np

from robobt.league.estimate.clocks import CameraClocks
from robobt.league.estimate.filter import VisionFilter
from robobt.league.picture import PictureWatch
from robobt.league.sources import VisionSources
from robobt.league.wire.notices import Notices
from robobt.league.wire.sockets import Address
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim import REALISM, SimSettings
from robobt.world import BALL_RADIUS, DIVISION_B, Frame, RobotCommand, RobotId, Team, wrap_angle
from robobt.world.rules import scorer

PERIOD, STARTED, WARM_UP, SECONDS = 1 / 60, 1000.0, 1.0, 6.0
NOISE = REALISM["realistic"]
SETTINGS = SimSettings(realism=NOISE)
MOUTH = SETTINGS.body.face + BALL_RADIUS
ME, OTHER = RobotId(Team.BLUE, 2), RobotId(Team.BLUE, 5)
SURE, WEAK = 0.9, 0.3
"""Confidences of a real detection and of a false one."""

FIRST, SECOND = ("10.0.0.5", 10006), ("10.0.0.6", 10006)
"""Two senders of vision."""

Pose = tuple[float, float, float]
Fault = Callable[[CameraFrame, np.random.Generator], None]
Sent = Iterator[tuple[CameraFrame, Address]]


@dataclass
class Scene:
    """Where ball and robots are at each time: x, y [m] and heading [rad]."""

    ball: Callable[[float], tuple[float, float]]
    robots: dict[RobotId, Callable[[float], Pose]]

    def seen(self, camera: int, number: int, time: float, rng: np.random.Generator) -> CameraFrame:
        """Return what a camera reports, with noise and gaps."""
        frame = CameraFrame(camera, number, STARTED + time, STARTED + time)
        if rng.random() >= NOISE.missing_ball:
            x, y = np.add(self.ball(time), NOISE.ball_noise * rng.standard_normal(2)).tolist()
            frame.balls.append(BallDetection(x, y, SURE))
        for robot, pose in self.robots.items():
            if rng.random() < NOISE.missing_robot:
                continue
            spread = (NOISE.robot_noise, NOISE.robot_noise, NOISE.heading_noise)
            x, y, heading = np.add(pose(time), np.multiply(spread, rng.standard_normal(3))).tolist()
            frame.robots.append(RobotDetection(robot, x, y, wrap_angle(heading), SURE))
        return frame

    def errors(self, frame: Frame, time: float) -> dict[str, float]:
        """Return the errors of a frame, in SI units; a robot that is missing counts as 1 m off."""
        step, ball = 1e-4, self.ball(time)
        after = self.ball(time + step)
        found = {
            "ball": hypot(frame.ball.x - ball[0], frame.ball.y - ball[1]),
            "ball speed": hypot(
                frame.ball.vx - (after[0] - ball[0]) / step, frame.ball.vy - (after[1] - ball[1]) / step
            ),
            "robot": 0.0,
            "robot speed": 0.0,
            "heading": 0.0,
            "turn": 0.0,
        }
        known = frame.robots()
        for robot, pose in self.robots.items():
            (x, y, h), (nx, ny, nh), state = pose(time), pose(time + step), known.get(robot)
            if state is None:
                found["robot"] = 1.0
                continue
            turn = wrap_angle(nh - h) / step
            each = {
                "robot": hypot(state.x - x, state.y - y),
                "robot speed": hypot(state.vx - (nx - x) / step, state.vy - (ny - y) / step),
                "heading": abs(wrap_angle(state.heading - h)),
                "turn": abs(state.omega - turn),
            }
            found |= {name: max(found[name], value) for name, value in each.items()}
        return found


def rolled(speed: float, time: float) -> float:
    """Return how far a ball has rolled that began at a speed, before it comes to rest [m]."""
    return speed * time - SETTINGS.ball.roll_deceleration * time * time / 2


def played(spot: Pose = (1.0, -1.0, 0.7)) -> Scene:
    """Return the scene of the cases."""

    def circle(time: float) -> Pose:
        angle = time / 1.5
        return 1.5 * cos(angle), 1.5 * sin(angle), wrap_angle(angle)

    return Scene(lambda time: (-3.5 + rolled(1.8, time), 2.0), {ME: circle, OTHER: lambda _: spot})


def as_it_is(frame: CameraFrame, _: np.random.Generator) -> None:
    """Leave a camera's frame as it is."""


def phantoms(frame: CameraFrame, rng: np.random.Generator) -> None:
    """Add three false balls anywhere, one that stays, and a false robot under our number."""
    places = [*rng.uniform((-4.0, -2.5), (4.0, 2.5), (3, 2)).tolist(), [2.0, -2.0]]
    frame.balls[:0] = [BallDetection(x, y, WEAK) for x, y in places]
    frame.robots.insert(0, RobotDetection(ME, -2.5, 1.0, 0.0, WEAK))


def weak_first(frame: CameraFrame, _: np.random.Generator) -> None:
    """Show a false ball and a false robot that stay, and for the first half second nothing else."""
    if frame.captured < STARTED + 0.5:
        frame.balls.clear()
        frame.robots = [seen for seen in frame.robots if seen.robot != ME]
    frame.balls.insert(0, BallDetection(2.0, -2.0, WEAK))
    frame.robots.insert(0, RobotDetection(ME, -2.5, 1.0, 0.0, WEAK))


def swapped(frame: CameraFrame, _: np.random.Generator) -> None:
    """Exchange the numbers of our two robots in ten frames of a second."""
    if frame.number % 60 >= 50:
        for seen in frame.robots:
            seen.robot = OTHER if seen.robot == ME else ME


def gaps(frame: CameraFrame, _: np.random.Generator) -> None:
    """Let the camera see nothing for 0.1 s of each second."""
    if frame.number % 60 >= 54:
        frame.balls.clear()
        frame.robots.clear()


def turned(each: int, by: float, frame: CameraFrame, _: np.random.Generator) -> None:
    """Turn the headings of one frame in several."""
    if frame.number % each == 0:
        for seen in frame.robots:
            seen.heading = wrap_angle((seen.heading or 0.0) + by)


def stream(
    scene: Scene,
    offsets: list[tuple[float, float]],
    late: list[float],
    rng: np.random.Generator,
    fault: Fault = as_it_is,
    seconds: float = SECONDS,
) -> Sent:
    """Yield the frames of cameras with these offsets [m] and delays to the first one's frames [s]."""
    for number in range(round(seconds / PERIOD)):
        for camera, (dx, dy) in enumerate(offsets):
            frame = scene.seen(camera, number, number * PERIOD + late[camera], rng)
            detections: list[BallDetection | RobotDetection] = [*frame.balls, *frame.robots]
            for seen in detections:
                seen.x += dx
                seen.y += dy
            fault(frame, rng)
            yield frame, FIRST


def largest(scene: Scene, sent: Sent) -> dict[str, float]:
    """Return the largest errors after the first second, as a frame goes from its sender to the filter."""
    known, worst, arrived = VisionFilter(DIVISION_B, SETTINGS), dict[str, float](), STARTED
    sources, clocks = VisionSources(Notices()), CameraClocks()
    for frame, sender in sent:
        if sender == FIRST and frame.camera == 0:
            arrived = frame.captured
        robots = known.frame_at(known.captured or arrived).robots()
        seen = {robot: (state.x, state.y) for robot, state in robots.items()}
        if not sources.takes(frame, sender, arrived, partial(dict, seen)):
            continue
        clocks.align(frame, arrived)
        if not known.add(frame) or frame.captured < STARTED + WARM_UP:
            continue
        for name, error in scene.errors(known.frame_at(frame.captured), frame.captured - STARTED).items():
            worst[name] = max(error, worst.get(name, 0.0))
    return worst


def two_sources(rng: np.random.Generator) -> Sent:
    """Send from a second address our camera with everything 2 m away and a clock 30 s ahead."""
    for number, (frame, sender) in enumerate(stream(played(), HERE, [0.0], rng)):
        yield frame, sender
        if number > 30:
            ahead = frame.captured + 30.0
            other = CameraFrame(0, number + 7, ahead, ahead)
            other.robots = [RobotDetection(s.robot, s.x, s.y + 2.0, s.heading) for s in frame.robots]
            yield other, SECOND


def empty_source(rng: np.random.Generator) -> Sent:
    """Send from a second address frames of another camera that see nothing, ahead of time."""
    for number, (frame, sender) in enumerate(stream(played(), HERE, [0.0], rng)):
        yield frame, sender
        if number % 15 == 0:
            yield CameraFrame(5, number, frame.captured + 0.4, frame.captured + 0.4), SECOND


def two_clocks(apart: float, rng: np.random.Generator) -> Sent:
    """Shift the clock of the second camera."""
    for frame, sender in stream(played(), PLACES[:2], [0.0, 0.0], rng):
        if frame.camera == 1:
            frame.captured += apart
            frame.sent += apart
        yield frame, sender


def stops_after(seconds: float) -> float:
    """Return how long a robot is commanded on at 1 m/s while its picture stands still [s]."""
    watch, command = PictureWatch(Notices()), RobotCommand(1.0)
    seen, last = Scene(lambda _: (0.0, 0.0), {ME: lambda t: (t, 0.0, 0.0)}), 0.0
    rng = np.random.default_rng(0)
    for number in range(round((1.0 + seconds) / PERIOD)):
        time = number * PERIOD
        if time < 1.0:
            frame = seen.seen(0, number, time, rng)
        watch.see(frame, time)
        if watch.checked({ME: command}, time)[ME].vx:
            last = time - 1.0
    return last


HERE, PLACES = [(0.0, 0.0)], [(0.03, -0.04), (-0.05, 0.0), (0.02, 0.03), (-0.01, 0.02)]
LATE = [0.0, 0.004, 0.008, 0.012]


def one_camera(fault: Fault, rng: np.random.Generator) -> Sent:
    """Return what one camera sends with a fault."""
    return stream(played(), HERE, [0.0], rng, fault)


CASES: dict[str, Callable[[np.random.Generator], Sent]] = {
    "one camera, no fault": partial(one_camera, as_it_is),
    "two cameras, 9 cm apart": lambda rng: stream(played(), PLACES[:2], LATE[:2], rng),
    "four cameras, up to 9 cm apart": lambda rng: stream(played(), PLACES, LATE, rng),
    "false balls, a false robot": partial(one_camera, phantoms),
    "false ball and robot seen first": partial(one_camera, weak_first),
    "numbers exchanged for 0.17 s": partial(one_camera, swapped),
    "nothing seen for 0.1 s": partial(one_camera, gaps),
    "every tenth heading half a turn off": partial(one_camera, partial(turned, 10, pi)),
    "every third heading 1 rad off": partial(one_camera, partial(turned, 3, 1.0)),
    "another source, robots elsewhere": two_sources,
    "another source that sees nothing": empty_source,
    "two cameras, clocks 2 s apart": partial(two_clocks, 2.0),
    "two cameras, clocks 1 h apart": partial(two_clocks, -3600.0),
}


def drawn(kind: str, seed: int, alone: bool) -> tuple[float, float]:
    """Return the largest errors of a draw's decisions or speeds: of the ball, then of the robot.

    For kinds "has", "has not" and "goal" it is the share of frames, or of goals, decided wrongly.
    """
    rng = np.random.default_rng([seed, 1])
    count, angle, speed = int(rng.integers(2, 5)), float(rng.uniform(-pi, pi)), float(rng.uniform(0.5, 3.0))
    offsets = [(d * cos(a), d * sin(a)) for d, a in rng.uniform((0.0, -pi), (0.05, pi), (count, 2)).tolist()]
    late = sorted(rng.uniform(0.0, PERIOD, count).tolist())
    if alone:
        offsets, late = HERE, [0.0]
    c, s = cos(angle), sin(angle)
    speed = {"rest": 0.0, "goal": max(1.5, speed), "has": 0.4 * speed}.get(kind, speed)

    def along(time: float, ahead: float = 0.0) -> tuple[float, float]:
        way = ahead + speed * (time - 1.5)
        return c * way, s * way

    gap = {"has": MOUTH, "has not": MOUTH + 0.03}.get(kind)
    scene = Scene(
        partial(along, ahead=gap) if gap else lambda time: (along(time)[0], along(time)[1] + 0.8),
        {ME: lambda time: (*along(time), angle)},
    )
    if kind == "goal":
        aside = float(rng.uniform(-0.35, 0.35))
        scene.ball = lambda time: (4.5 + speed * (time - 1.5), aside)
    frames = stream(scene, offsets, late, rng, seconds=2.5 if kind == "goal" else 3.0)
    if kind in ("rest", "moving"):
        worst = largest(scene, frames)
        return worst["ball speed"], worst["robot speed"]
    known, before = VisionFilter(DIVISION_B, SETTINGS), None
    looked = wrong = 0
    goals: list[Team] = []
    for frame, _ in frames:
        known.add(frame)
        now = known.frame_at(frame.captured)
        if frame.captured - STARTED > WARM_UP:
            me = now.robots().get(ME)
            looked += 1
            wrong += me is None or me.ball_contact != (kind == "has")
            if before is not None and (scored := scorer(DIVISION_B, before.ball, now.ball)) is not None:
                goals.append(scored)
            before = now
    if kind == "goal":
        return float(goals != [Team.BLUE]), 0.0
    return wrong / looked, 0.0


def show_draws(draws: int) -> None:
    """Print the largest errors of each kind in many draws."""
    print(f"{draws} draws         ball, m/s: one camera  2 to 4     robot, m/s: one camera  2 to 4")
    for kind in ("rest", "moving"):
        ball, robot = zip(
            *(np.max([drawn(kind, seed, alone) for seed in range(draws)], 0) for alone in (True, False)),
            strict=True,
        )
        print(f"{kind:12}{ball[0]:28.3f}{ball[1]:8.3f}{robot[0]:26.3f}{robot[1]:8.3f}", flush=True)
    print(f"{draws} draws, wrong:           one camera  2 to 4  frames: one camera  2 to 4")
    for kind in ("has", "has not", "goal"):
        wrong = [[drawn(kind, seed, alone)[0] for seed in range(draws)] for alone in (True, False)]
        one, several = (int(np.count_nonzero(shares)) for shares in wrong)
        shares = [f"{np.mean(shares):.3%}" for shares in wrong]
        print(f"{kind:12}{one:28}{several:8}{shares[0]:>20}{shares[1]:>8}", flush=True)


def show_cases(seed: int) -> None:
    """Print the largest errors of each case."""
    names = ("ball", "ball speed", "robot", "robot speed", "heading", "turn")
    print(f"{'largest errors':38}{'ball m':>8}{'m/s':>8}{'robot m':>9}{'m/s':>8}{'rad':>8}{'rad/s':>8}")
    for title, frames in CASES.items():
        worst = largest(played(), frames(np.random.default_rng(seed)))
        row = [f"{worst[name]:{9 if name == 'robot' else 8}.3f}" for name in names]
        print(f"{title:38}{''.join(row)}", flush=True)
    print(f"A picture that stands still: {stops_after(3.0):.3f} s until the last moving command.")


def main(words: list[str] | None = None) -> None:
    """Print one of the two tables."""
    parser = argparse.ArgumentParser(description="the vision filter where vision is at fault")
    parser.add_argument("--draws", type=int, default=0, help="scenes of cameras that disagree, of each kind")
    parser.add_argument("--seed", type=int, default=0, help="of the cases")
    given = parser.parse_args(words)
    if given.draws:
        show_draws(given.draws)
    else:
        show_cases(given.seed)
