"""From detections to frames: who is where, how fast, and who has the ball.

No sockets and no clock here: all times are arguments, in the clock of the
detections' captures.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, hypot, sin

from robobt.league.estimate.ball_track import BallMotion, BallTrack, rolled
from robobt.league.estimate.robot_track import Motion, RobotTrack, SentCommand, predicted
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

_LEAST_ROBOT_NOISE, _LEAST_BALL_NOISE, _LEAST_HEADING_NOISE = 0.0013, 0.0014, 0.01
"""Noise that is reckoned with even where none is announced [m, m, rad]. Source: ER-Force's Realistic."""

_LEAST_CONFIDENCE = 0.1
"""Detections that the vision itself believes in less are left out."""

_CONFIRMED = 3
"""Sightings at about one place before something new, or something far from where it was, is believed."""

_ROBOT_GATE, _BALL_GATE = 0.15, 0.12
"""How far off a detection may be besides what the object may have moved [m]."""

_BALL_SPEED = 10.0
"""No ball is faster [m/s]."""

_MOST_UNSEEN = 3.0
"""A search for a ball out of sight is widened up to so far [m]."""

_ROBOT_GONE = 1.0
"""A robot that is not detected for so long has left the field [s]."""

_FORGET = 0.5
"""Commands older than this have no bearing on any prediction [s]."""

_JUMP_BACK, _JUMP_AHEAD = 0.5, 5.0
"""A source whose capture times jump further was started anew [s]."""

_GAP = 0.5
"""Capture times that are further ahead are believed only when more frames say the same [s]."""

_MOUTH_SLACK = 0.004
"""What the filter's own error adds to the depth in which the ball counts as in the mouth [m]."""

_HOLD_SLACK, _HOLD_SPEED = 0.012, 0.5
"""A ball this close to the mouth and this slow relative to it is carried along [m, m/s]."""

_TOUCH_GAP = 0.006
"""Gap between hull and ball that counts as a touch [m]."""

_PUSHED_GAP = 0.05
"""Gap between hull and ball in which the robot may change the ball's motion any time [m]."""

_FEEDBACK_REACH = 0.05
"""A robot's own ball sensor is believed while the ball is seen this close to its mouth [m]."""


@dataclass(slots=True)
class _Stranger:
    """Something seen where nothing was expected."""

    x: float
    y: float
    time: float
    seen: int = 1


@dataclass(slots=True)
class _Hold:
    """Who carries the ball, and where in that robot's frame it lies [m]."""

    robot: RobotId
    ahead: float
    aside: float


class VisionFilter:
    """Merges the cameras' detections and predicts from them.

    Args:
        field: dimensions; may be replaced when the vision says otherwise.
        settings: the physics to be expected: ball, body, limits and noise.
        limits: of single robots, where they differ.

    Attributes:
        captured: capture time of the newest frame, None before the first [s].
        duplicates: frames that had been seen already, or came too late to be of use.
        restarts: how often the source was started anew.
        unbelieved: frames with a time that no other frame confirmed.
    """

    def __init__(
        self,
        field: FieldGeometry,
        settings: SimSettings | None = None,
        limits: Mapping[RobotId, RobotLimits] | None = None,
    ) -> None:
        self.field = field
        self.settings = settings or SimSettings()
        self._limits = dict(limits or {})
        realism = self.settings.realism
        self._robot_noise = max(realism.robot_noise, _LEAST_ROBOT_NOISE)
        self._ball_noise = max(realism.ball_noise, _LEAST_BALL_NOISE)
        self._heading_noise = max(realism.heading_noise, _LEAST_HEADING_NOISE)
        self.captured: float | None = None
        self.duplicates = self.restarts = self.unbelieved = 0
        self._elsewhen: tuple[float, int] | None = None
        self._cameras: dict[int, float] = {}
        self._robots: dict[RobotId, RobotTrack] = {}
        self._ball: BallTrack | None = None
        self._ball_seen = 0.0
        self._ball_camera: int | None = None
        self._hold: _Hold | None = None
        self._strangers: dict[RobotId | None, _Stranger] = {}
        self._sent: dict[RobotId, list[SentCommand]] = {}
        self._feedback: dict[RobotId, bool] = {}
        self._last_touch: RobotId | None = None

    def clear(self) -> None:
        """Forget everything but the field."""
        self.captured = None
        self._cameras.clear()
        self._robots.clear()
        self._ball = self._hold = self._last_touch = None
        self._strangers.clear()
        self._sent.clear()
        self._feedback.clear()

    def sent(self, time: float, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Remember the commands that take effect at ``time``; they are predicted with."""
        for robot, command in commands.items():
            queue = self._sent.setdefault(robot, [])
            queue.append(SentCommand(time, command.vx, command.vy, command.omega))
            # One that is older than all predictions has to stay: it is still in force.
            while len(queue) > 1 and queue[1].time < time - _FORGET:
                queue.pop(0)

    def feedback(self, robot: RobotId, contact: bool) -> None:
        """What a robot's own sensor says about the ball in its mouth."""
        self._feedback[robot] = contact

    def touched(self, robot: RobotId | None) -> None:
        """Set who touched the ball last, as at a start."""
        self._last_touch = robot

    def ball_put(self, x: float, y: float) -> None:
        """Believe that the ball lies there until it is seen somewhere else: a robot may hide it."""
        if self.captured is not None:
            self._ball = BallTrack(x, y, self.captured, self.settings.ball, self._ball_noise)
            self._ball_seen = self.captured
            self._hold = None
            self._strangers.pop(None, None)

    def add(self, frame: CameraFrame) -> bool:
        """Use a camera's frame; False for one that brings nothing new."""
        time = frame.captured
        if self.captured is not None and not -_JUMP_BACK < time - self.captured < _GAP:
            if not self._confirmed(time):
                self.unbelieved += 1
                return False
            if not -_JUMP_BACK < time - self.captured < _JUMP_AHEAD:
                self.clear()
                self.restarts += 1
        self._elsewhen = None
        last = self._cameras.get(frame.camera)
        if last is not None and time <= last:
            self.duplicates += 1
            return False
        self._cameras[frame.camera] = time
        self.captured = time if self.captured is None else max(time, self.captured)
        for robot, detections in _by_robot(frame.robots).items():
            self._add_robot(robot, detections, time)
        for robot in [robot for robot, track in self._robots.items() if time - track.time > _ROBOT_GONE]:
            del self._robots[robot]
        balls = [ball for ball in frame.balls if ball.confidence >= _LEAST_CONFIDENCE]
        self._add_balls(balls, time, frame.camera)
        return True

    def robots(self) -> list[RobotId]:
        """The robots on the field."""
        return sorted(self._robots)

    def sees_ball(self) -> bool:
        """Whether the ball has been seen at all."""
        return self._ball is not None

    def ball_unseen(self) -> float:
        """How long the ball has not been detected [s]."""
        return 0.0 if self._ball is None or self.captured is None else self.captured - self._ball_seen

    def frame_at(self, time: float) -> Frame:
        """The field at ``time``, predicted from the captures with the commands that were sent.

        A ball that was never seen lies in the centre.
        """
        motions = {robot: self._robot_at(robot, time) for robot in sorted(self._robots)}
        ball = self._ball_at(time, motions)
        own: dict[Team, list[RobotState]] = {team: [] for team in Team}
        for robot, m in motions.items():
            contact = self._has_ball(robot, m, ball)
            own[robot.team].append(
                RobotState(
                    robot.number,
                    m.x,
                    m.y,
                    m.heading,
                    m.vx,
                    m.vy,
                    m.omega,
                    contact,
                    self._robots[robot].limits,
                )
            )
        return Frame(
            time,
            self.field,
            BallState(ball.x, ball.y, ball.vx, ball.vy),
            tuple(own[Team.BLUE]),
            tuple(own[Team.YELLOW]),
            last_touch=self._last_touch,
        )

    def _confirmed(self, time: float) -> bool:
        """Whether frames in a row have told of about this time, so that it is no single frame's slip."""
        seen = 1
        if self._elsewhen is not None and abs(time - self._elsewhen[0]) < _GAP:
            seen = self._elsewhen[1] + 1
        self._elsewhen = (time, seen)
        return seen >= _CONFIRMED

    def _add_robot(self, robot: RobotId, detections: list[RobotDetection], time: float) -> None:
        track = self._robots.get(robot)
        if track is None:
            best = max(detections, key=lambda detection: detection.confidence)
            if best.heading is not None and self._familiar(robot, best.x, best.y, time, _ROBOT_GATE):
                self._robots[robot] = RobotTrack(
                    best.x,
                    best.y,
                    best.heading,
                    time,
                    self._limits.get(robot, self.settings.limits),
                    self._robot_noise,
                    self._heading_noise,
                )
            return
        lag = time - track.time
        track.advance(time, self._sent.get(robot, []))
        m = track.motion
        # A camera that is a little late saw the robot a little further back.
        late = min(0.0, lag)
        near = min(
            detections, key=lambda found: track.deviation(found.x - m.vx * late, found.y - m.vy * late)
        )
        x, y = near.x - m.vx * late, near.y - m.vy * late
        gate = _ROBOT_GATE + track.limits.max_speed * max(0.0, lag)
        if track.deviation(x, y) <= gate:
            track.correct(x, y, near.heading)
            self._strangers.pop(robot, None)
        elif near.heading is not None and self._familiar(robot, x, y, time, gate):
            track.restart(x, y, near.heading, time)

    def _add_balls(self, balls: list[BallDetection], time: float, camera: int) -> None:
        track = self._ball
        if not balls:
            return
        if track is None:
            best = max(balls, key=lambda ball: ball.confidence)
            if self._familiar(None, best.x, best.y, time, _BALL_GATE):
                self._ball = BallTrack(best.x, best.y, time, self.settings.ball, self._ball_noise)
                self._ball_seen = time
            return
        motions = {robot: self._robot_at(robot, time) for robot in self._robots}
        kickable = False
        if time > track.time:
            if self._hold is not None and self._hold.robot in motions:
                kickable = True
                track.advance(time, True)
                track.carried_to(_carried(self._hold, motions[self._hold.robot]), time)
            else:
                kickable = self._pushed(track.motion, motions)
                track.advance(time, kickable)
        nearest = min(balls, key=lambda ball: track.surprise(ball.x, ball.y))
        gate = min(_MOST_UNSEEN, _BALL_GATE + _BALL_SPEED * max(0.0, time - self._ball_seen))
        if track.surprise(nearest.x, nearest.y) <= gate:
            # Cameras that disagree about a place would make kicks of the difference.
            track.correct(nearest.x, nearest.y, kickable and camera == self._ball_camera)
            self._strangers.pop(None, None)
        elif self._familiar(None, nearest.x, nearest.y, time, gate):
            track.restart(nearest.x, nearest.y, time)
        else:
            return
        self._ball_seen, self._ball_camera = max(time, self._ball_seen), camera
        self._look_who_has_it(track.motion, motions)

    def _familiar(self, robot: RobotId | None, x: float, y: float, time: float, gate: float) -> bool:
        """Whether what was seen out of place has been seen there often enough."""
        known = self._strangers.get(robot)
        if known is None or time - known.time > _ROBOT_GONE or hypot(x - known.x, y - known.y) > gate:
            self._strangers[robot] = _Stranger(x, y, time)
            return False
        known.x, known.y, known.time = x, y, time
        known.seen += 1
        if known.seen < _CONFIRMED:
            return False
        del self._strangers[robot]
        return True

    def _robot_at(self, robot: RobotId, time: float) -> Motion:
        track = self._robots[robot]
        return predicted(track.motion, track.time, time, self._sent.get(robot, []), track.limits)

    def _ball_at(self, time: float, motions: Mapping[RobotId, Motion]) -> BallMotion:
        track = self._ball
        if track is None:
            return BallMotion(0.0, 0.0)
        if self._hold is not None and self._hold.robot in motions:
            return _carried(self._hold, motions[self._hold.robot])
        if time <= track.time:
            return track.motion
        ball = rolled(track.motion, time - track.time, self.settings.ball)
        return _stopped_by_robots(track.motion, ball, motions)

    def _pushed(self, ball: BallMotion, motions: Mapping[RobotId, Motion]) -> bool:
        reach = ROBOT_RADIUS + BALL_RADIUS + _PUSHED_GAP
        return any(hypot(ball.x - m.x, ball.y - m.y) < reach for m in motions.values())

    def _look_who_has_it(self, ball: BallMotion, motions: Mapping[RobotId, Motion]) -> None:
        self._hold = None
        closest = ROBOT_RADIUS + BALL_RADIUS + _TOUCH_GAP
        for robot, m in motions.items():
            gap = hypot(ball.x - m.x, ball.y - m.y)
            if gap > closest:
                continue
            self._last_touch = robot
            ahead, aside = _in_frame_of(m, ball)
            # The mouth's own velocity where the ball lies.
            vx, vy = m.vx - m.omega * (ball.y - m.y), m.vy + m.omega * (ball.x - m.x)
            if self._in_mouth(ahead, aside, _HOLD_SLACK) and hypot(ball.vx - vx, ball.vy - vy) < _HOLD_SPEED:
                self._hold = _Hold(robot, ahead, aside)

    def _has_ball(self, robot: RobotId, m: Motion, ball: BallMotion) -> bool:
        if self._ball is None:
            return False
        ahead, aside = _in_frame_of(m, ball)
        told = self._feedback.get(robot)
        if told is not None and self._in_mouth(ahead, aside, _FEEDBACK_REACH):
            return told
        return self._in_mouth(ahead, aside, _MOUTH_SLACK)

    def _in_mouth(self, ahead: float, aside: float, slack: float) -> bool:
        body = self.settings.body
        depth = body.face + BALL_RADIUS + body.sensor_depth + slack
        return 0.0 < ahead <= depth and abs(aside) <= body.mouth_width / 2


def _by_robot(detections: list[RobotDetection]) -> dict[RobotId, list[RobotDetection]]:
    found: dict[RobotId, list[RobotDetection]] = {}
    for detection in detections:
        if detection.confidence >= _LEAST_CONFIDENCE:
            found.setdefault(detection.robot, []).append(detection)
    return found


def _in_frame_of(m: Motion, ball: BallMotion) -> tuple[float, float]:
    dx, dy = ball.x - m.x, ball.y - m.y
    c, s = cos(m.heading), sin(m.heading)
    return c * dx + s * dy, c * dy - s * dx


def _carried(hold: _Hold, m: Motion) -> BallMotion:
    c, s = cos(m.heading), sin(m.heading)
    dx, dy = c * hold.ahead - s * hold.aside, s * hold.ahead + c * hold.aside
    return BallMotion(m.x + dx, m.y + dy, m.vx - m.omega * dy, m.vy + m.omega * dx)


def _stopped_by_robots(
    before: BallMotion, after: BallMotion, motions: Mapping[RobotId, Motion]
) -> BallMotion:
    """A prediction goes no further than the first robot in its way."""
    reach = ROBOT_RADIUS + BALL_RADIUS
    dx, dy = after.x - before.x, after.y - before.y
    way = dx * dx + dy * dy
    if way < 1e-8:
        return after
    first, met = 1.0, None
    for m in motions.values():
        ox, oy = before.x - m.x, before.y - m.y
        outside = ox * ox + oy * oy - reach * reach
        along = ox * dx + oy * dy
        root = along * along - way * outside
        if outside <= 0.0 or along >= 0.0 or root < 0.0:
            continue
        share = (-along - root**0.5) / way
        if share < first:
            first, met = share, m
    if met is None:
        return after
    return BallMotion(before.x + dx * first, before.y + dy * first, met.vx, met.vy)
