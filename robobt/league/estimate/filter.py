"""From detections to frames: positions, velocities and possession of the ball.

No sockets and no clock: all times are arguments, on the clock of the detections'
captures.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, inf, isfinite
from statistics import fmean

from robobt.league.estimate.ball_track import BallMotion, BallTrack, predict_ball
from robobt.league.estimate.coming_kick import kicked_ball
from robobt.league.estimate.flight import FlightWatch
from robobt.league.estimate.kicks import Kick, KickWatch
from robobt.league.estimate.possession import Possession, near_robot, stop_at_robots
from robobt.league.estimate.rivals import Rivals
from robobt.league.estimate.robot_track import (
    RobotMotion,
    RobotSensing,
    RobotTrack,
    Sent,
    SentCommands,
    predict_robot,
)
from robobt.league.wire.geometry import CameraPlace
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.delay import DelayWatch
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.sketch import Sketch
from robobt.world.state import RECEIVED_HEIGHT, ROBOT_HEIGHT, BallState, Frame, RobotId, RobotState

_NEVER = -inf, 0
"""No odd capture time, and how many frames had it."""

_MIN_ROBOT_NOISE, _MIN_BALL_NOISE, _MIN_HEADING_NOISE = 0.0013, 0.0014, 0.01
"""Least noise assumed [m, m, rad]. Source: ER-Force's Realistic."""

DETECTIONS, COVARIANCE = "detections", "covariance"
"""Drawing layers of the cameras' detections and of the filter's uncertainty."""

_UNSEEN = 0.05
"""Time from which a ball that no camera detects counts as hidden, and not as missed by chance [s]."""

_RADIUS_95 = 2.448
"""Radius of the circle that holds 95 % of a normal distribution of two dimensions, in standard deviations."""

_MIN_CONFIDENCE = 0.1
"""Detections of lower confidence are ignored."""

_OUTLIER_CONFIRMATIONS = 3
"""Detections at about one place, or frames of about one time, after which an outlier is believed."""

_ROBOT_GATE, _BALL_GATE = 0.15, 0.12
"""Largest deviation of a detection beyond what the object may have moved [m]."""

_MAX_BALL_SPEED = 10.0
"""No ball is faster [m/s]."""

_MAX_GATE = 3.0
"""The search for a ball out of sight is widened up to this distance [m]."""

_ROBOT_TIMEOUT = 1.0
"""A robot that is not detected for this long has left the field [s]."""

_COMMAND_MEMORY = 0.5
"""Commands older than this affect no prediction [s]."""

_JUMP_BACK, _JUMP_AHEAD = 0.5, 5.0
"""A source whose capture times jump further was restarted [s]."""

_OTHER_CAMERA = 0.05
"""After this time without a camera's detection another camera's is used for measuring delays [s]."""

_CAMERA_LATENESS = 0.002
"""A camera whose frame is this much older than the newest is late [s]."""

_CAPTURE_GAP = 0.5
"""Capture times further ahead need confirmation by more frames [s]."""


class VisionFilter:
    """Merges the cameras' detections and predicts from them.

    ``field`` may be replaced when the vision reports another; ``settings`` are the physics to expect,
    ``limits`` those of individual robots, where they differ. ``measured`` is whether predictions reckon with
    the delays that are measured, instead of those of the settings.

    Attributes:
        delays: measures the robots' delays.
        cameras: where those are, by number; chips are seen by these only.
        captured: capture time of the newest frame, None before the first [s].
        restarts: how often the source was restarted.
        possession: who has the ball.
        kicks: what was seen of kicks since this list was last emptied.
    """

    def __init__(
        self,
        field: FieldGeometry,
        settings: SimSettings | None = None,
        limits: Mapping[RobotId, RobotLimits] | None = None,
        measured: bool = False,
    ) -> None:
        self.field = field
        self.settings = settings or SimSettings()
        self._measured = measured
        self._ball_model = self.settings.ball.model
        self._limits = dict(limits or {})
        realism = self.settings.realism
        self.delays = DelayWatch(self.settings.limits, self._limits, realism.command_delay)
        robot_noise = max(realism.robot_noise, _MIN_ROBOT_NOISE)
        self._robot_noises = robot_noise, max(realism.heading_noise, _MIN_HEADING_NOISE)
        self._ball_noise = max(realism.ball_noise, _MIN_BALL_NOISE)
        self.restarts = 0
        self.cameras: dict[int, CameraPlace] = {}
        self._odd_time = _NEVER
        self._ball_seen = 0.0
        self.clear()

    def clear(self) -> None:
        """Forget everything but the field."""
        self.captured: float | None = None
        self.possession = Possession(self.settings.body)
        self.kicks: list[Kick] = []
        self._kick_watch = KickWatch(self.settings.body.face)
        self._flights = FlightWatch(self.settings.ball, self._ball_noise, self.cameras)
        self._cameras: dict[int, float] = {}
        self._seen: dict[int, CameraFrame] = {}
        self._robots: dict[RobotId, RobotTrack] = {}
        self._ball: BallTrack | None = None
        self._moved_unseen = -inf
        self._sensing = RobotSensing(*self._robot_noises)
        # One mean for balls and robots keeps a ball beside its robot where different cameras see the two.
        self._offsets = self._sensing.offsets
        self._ball_rivals = Rivals(_OUTLIER_CONFIRMATIONS, _BALL_GATE, _MAX_BALL_SPEED)
        self._robot_rivals: dict[RobotId, Rivals] = {}
        self._sent: dict[RobotId, SentCommands] = {}
        self._watched: dict[RobotId, tuple[int, float]] = {}
        self.delays.interrupt()

    def sent(self, time: float, commands: Mapping[RobotId, RobotCommand], link_delay: float = 0.0) -> None:
        """Record commands, for predictions.

        Args:
            time: when they are sent [s].
            commands: by robot.
            link_delay: from there until they reach the robots [s]. When they take effect each robot's limits
                tell. Where predictions reckon with measured delays, these stand in place of both.
        """
        self.delays.sent(time, commands)
        for robot, command in commands.items():
            queue = self._sent.setdefault(robot, [])
            if self._measured:
                since = time + self.delays.expected(robot)
                # Where a delay has become shorter, commands on their way still come in their order.
                queue.append(Sent(max(since, queue[-1].since) if queue else since, command))
            else:
                queue.append(Sent(time + self._limits_of(robot).obeys_after(link_delay), command))
            # The last command before the horizon has to stay: it is still in force.
            while len(queue) > 1 and queue[1].since < time - _COMMAND_MEMORY:
                queue.pop(0)

    def put_ball(self, x: float, y: float) -> None:
        """Assume that the ball is there until it is seen elsewhere, because a robot may hide it."""
        if self.captured is not None:
            self._ball = self._new_ball(x, y, self.captured)
            self._ball_seen = self.captured
            self.possession.holds = []
            self._flights.clear()
            self._ball_rivals = Rivals(_OUTLIER_CONFIRMATIONS, _BALL_GATE, _MAX_BALL_SPEED)

    def add(self, frame: CameraFrame, now: float | None = None) -> bool:
        """Use a camera's frame; return False for a duplicate, a late frame or an unconfirmed time.

        ``now`` is the time of the source's clock as far as it is known [s]: frames of about then are those of
        a source that went on while nobody listened.
        """
        time = frame.captured
        if self.captured is not None and not -_JUMP_BACK < time - self.captured < _CAPTURE_GAP:
            if not self._confirmed_time(time):
                return False
            if not -_JUMP_BACK < time - self.captured < _JUMP_AHEAD:
                self.restarts += now is None or not self.captured - _JUMP_BACK < time < now + _JUMP_AHEAD
                self.clear()
        self._odd_time = _NEVER
        last = self._cameras.get(frame.camera)
        if last is not None and time <= last:
            return False
        self._cameras[frame.camera] = time
        self._seen[frame.camera] = frame
        self.captured = time if self.captured is None else max(time, self.captured)
        detections: dict[RobotId, list[RobotDetection]] = {}
        for ball in frame.balls:
            ball.confidence = min(ball.confidence, 1.0)
        for robot in frame.robots:
            robot.confidence = min(robot.confidence, 1.0)
            if robot.heading is not None and not isfinite(robot.heading):
                robot.heading = None
            if robot.confidence >= _MIN_CONFIDENCE:
                detections.setdefault(robot.robot, []).append(robot)
        for number, found in detections.items():
            self._add_robot(number, found, time, frame.camera)
        for number, track in list(self._robots.items()):
            if time - track.time > _ROBOT_TIMEOUT:
                del self._robots[number], self._robot_rivals[number]
        balls = [ball for ball in frame.balls if ball.confidence >= _MIN_CONFIDENCE]
        if balls:
            self._add_balls(balls, time, frame.camera)
        if self._ball is not None and time - self._ball_seen > _UNSEEN and time > self._ball.time:
            self._follow_unseen(self._ball, time)
        return True

    def robots(self) -> list[RobotId]:
        """Return the robots on the field."""
        return sorted(self._robots)

    def draw(self, sketch: Sketch) -> None:
        """Draw each camera's last detections, and the area in which the filter has each object at 95 %."""
        if sketch.wants(DETECTIONS):
            for seen in self._seen.values():
                places = [(it.x, it.y) for it in seen.robots] + [(it.x, it.y) for it in seen.balls]
                for place in places:
                    sketch.point(DETECTIONS, place)
        if sketch.wants(COVARIANCE):
            for track in (*self._robots.values(), *([self._ball] if self._ball is not None else ())):
                sketch.circle(COVARIANCE, (track.motion.x, track.motion.y), _RADIUS_95 * track.spread)

    def ball_unseen(self) -> float:
        """Return how long the ball has not been detected; infinity if it never was [s]."""
        return inf if self._ball is None or self.captured is None else self.captured - self._ball_seen

    def frame_at(self, time: float, to_effect: bool = False) -> Frame:
        """Return the field at ``time``, predicted with the commands that were sent.

        A ball that was never seen is put in the centre.

        Args:
            time: on the vision's clock [s].
            to_effect: whether to predict on to when a command moves a robot, less the reaction that pilots
                allow for: each commanded robot by its dead time, from ``time`` as the command's arrival, or
                by its measured delay, from ``time`` as the command's sending. All else is predicted on by the
                mean of these.
        """
        dead = {robot: self._effect_after(robot) for robot in self._sent} if to_effect else {}
        others = fmean(dead.values()) if dead else 0.0
        motions = {
            robot: self._robot_at(robot, time + dead.get(robot, others)) for robot in sorted(self._robots)
        }
        ball, last_touch, kicker = self._ball_at(time + others, motions), self.possession.last_touch, None
        kick = self._coming_kick(time + others, motions) if dead else None
        if kick is not None:
            kicker, ball = kick
            last_touch = kicker
        teams: dict[Team, list[RobotState]] = {team: [] for team in Team}
        for robot, m in motions.items():
            low = self._ball is not None and ball.z < RECEIVED_HEIGHT
            contact = low and robot != kicker and self.possession.has_ball(robot, m, ball)
            limits = self._robots[robot].limits
            teams[robot.team].append(
                RobotState(robot.number, m.x, m.y, m.heading, m.vx, m.vy, m.omega, contact, limits)
            )
        return Frame(
            time,
            self.field,
            BallState(ball.x, ball.y, ball.vx, ball.vy, ball.z, ball.vz),
            tuple(teams[Team.BLUE]),
            tuple(teams[Team.YELLOW]),
            last_touch=last_touch,
            ball_model=self._ball_model,
        )

    def _coming_kick(
        self, time: float, motions: Mapping[RobotId, RobotMotion]
    ) -> tuple[RobotId, BallMotion] | None:
        """Return the robot that kicks the ball before a time [s], and the ball then; None if none does."""
        track = self._ball
        if track is None or self._flights.at(time) is not None:
            return None
        holders = [hold.robot for hold in self.possession.holds]
        return kicked_ball(
            track.motion,
            track.time,
            time,
            self._robot_at,
            motions,
            self._sent,
            self._limits_of,
            holders,
            {robot for robot, reported in self.possession.feedback.items() if not reported},
            self._ball_model,
        )

    def _confirmed_time(self, time: float) -> bool:
        """Return whether enough consecutive frames had about this odd capture time."""
        before, count = self._odd_time
        count = count + 1 if abs(time - before) < _CAPTURE_GAP else 1
        self._odd_time = (time, count)
        return count >= _OUTLIER_CONFIRMATIONS

    def _add_robot(self, robot: RobotId, detections: list[RobotDetection], time: float, camera: int) -> None:
        limits = self._limits_of(robot)
        rivals = self._robot_rivals.get(robot)
        if rivals is None:
            rivals = self._robot_rivals[robot] = Rivals(_OUTLIER_CONFIRMATIONS, _ROBOT_GATE, limits.max_speed)
        track = self._robots.get(robot)
        if track is not None:
            detections = self._correct_robot(track, rivals, detections, time, camera)
        for seen in sorted(detections, key=_surest_first):
            if seen.heading is None:
                continue
            place = None if track is None else (track.motion.x, track.motion.y)
            occupied = track is not None and self._occupied(seen)
            if not rivals.believes(seen.x, seen.y, camera, seen.confidence, time, place, occupied):
                continue
            if track is None:
                track = self._robots[robot] = RobotTrack(
                    seen.x, seen.y, seen.heading, time, camera, limits, self._sensing
                )
            else:
                track.restart(seen.x, seen.y, seen.heading, time, camera)

    def _correct_robot(
        self, track: RobotTrack, rivals: Rivals, detections: list[RobotDetection], time: float, camera: int
    ) -> list[RobotDetection]:
        """Correct a robot's track with the detection that is its own; return the others."""
        seen_before = track.time
        lag = time - track.time
        track.advance(time, self._sent.get(detections[0].robot, []))
        m = track.motion
        # A camera that is slightly late saw the robot slightly further back.
        late = min(0.0, lag)
        deviations = [
            (track.deviation(seen.x - m.vx * late, seen.y - m.vy * late, camera), seen) for seen in detections
        ]
        gate = _ROBOT_GATE + track.limits.max_speed * max(0.0, lag)
        own = rivals.own(deviations, gate, seen_before)
        if own is None:
            return detections
        track.correct(own.x - m.vx * late, own.y - m.vy * late, camera)
        if own.heading is not None:
            track.correct_heading(own.heading, camera, own.confidence)
            self._measure(own.robot, own.x, own.y, own.heading, time, camera)
        rivals.saw_track(camera, own.confidence, time)
        return [seen for gap, seen in deviations if seen is not own and gap > gate]

    def _measure(self, robot: RobotId, x: float, y: float, heading: float, time: float, camera: int) -> None:
        """Compare where a robot is seen with its commands; by one camera, as others see it a little aside."""
        before, seen = self._watched.get(robot, (camera, time))
        if before == camera or time - seen > _OTHER_CAMERA:
            self._watched[robot] = camera, time
            self.delays.see(robot, time, x, y, heading)

    def _effect_after(self, robot: RobotId) -> float:
        """Return how far beyond a time of sending, or of arrival, a frame shows a robot [s]."""
        limits = self._limits_of(robot)
        return self.delays.expected(robot) - limits.reaction if self._measured else limits.shown_after(0.0)

    def _occupied(self, seen: RobotDetection) -> bool:
        """Return whether another robot of the team is tracked where one is seen: the number may be wrong."""
        return any(
            other != seen.robot
            and other.team is seen.robot.team
            and hypot(seen.x - track.motion.x, seen.y - track.motion.y) < _ROBOT_GATE
            for other, track in self._robots.items()
        )

    def _new_ball(self, x: float, y: float, time: float, camera: int | None = None) -> BallTrack:
        return BallTrack(x, y, time, self.settings.ball, self._ball_noise, self._offsets, camera)

    def _add_balls(self, balls: list[BallDetection], time: float, camera: int) -> None:
        track, rivals = self._ball, self._ball_rivals
        motions = {robot: self._robot_at(robot, time) for robot in self._robots}
        own: BallDetection | None = None
        if track is not None:
            own = self._correct_ball(track, balls, time, camera, motions)
        for ball in sorted(balls, key=_surest_first):
            if ball is own or (track is not None and track.deviation(ball.x, ball.y, camera) <= _BALL_GATE):
                continue
            place = None if track is None else (track.motion.x, track.motion.y)
            if not rivals.believes(ball.x, ball.y, camera, ball.confidence, time, place):
                continue
            if track is None:
                track = self._ball = self._new_ball(ball.x, ball.y, time, camera)
            else:
                track.restart(ball.x, ball.y, time, camera)
            own = ball
        if track is not None and own is not None:
            self._ball_seen = max(time, self._ball_seen)
            self._look_up(track, own, time, camera, motions)

    def _correct_ball(
        self,
        track: BallTrack,
        balls: list[BallDetection],
        time: float,
        camera: int,
        motions: Mapping[RobotId, RobotMotion],
    ) -> BallDetection | None:
        """Correct the ball's track with the detection that is its own; return that."""
        kickable = False
        if time > track.time:
            carried = self.possession.carried(motions)
            kickable = carried is not None or near_robot(track.motion, motions)
            track.advance(time, kickable)
            if carried is not None:
                track.carry(carried, time)
        rivals, seen_before, m = self._ball_rivals, self._ball_seen, track.motion
        gate = min(_MAX_GATE, _BALL_GATE + _MAX_BALL_SPEED * max(0.0, time - seen_before))
        # A camera that is late saw the ball further back.
        late = min(0.0, time - track.time)
        places = [(ball.x - m.vx * late, ball.y - m.vy * late, ball) for ball in balls]
        gaps = [(track.deviation(x, y, camera), ball) for x, y, ball in places]
        own = rivals.own(gaps, gate, seen_before)
        if own is None:
            return None
        # It may have been kicked since a late camera saw it.
        if late > -_CAMERA_LATENESS or not track.settling:
            track.correct(own.x - m.vx * late, own.y - m.vy * late, camera, kickable)
        if self._flights.hop is None:
            track.teach()
        rivals.saw_track(camera, own.confidence, time)
        return own

    def _follow_unseen(self, track: BallTrack, time: float) -> None:
        """Let a ball that cameras no longer see go where sensors and hulls say that it must be."""
        if self._flights.at(time) is not None:
            return
        motions = {robot: self._robot_at(robot, time) for robot in self._robots}
        predicted, held = self._ball_at(time, motions), bool(self.possession.holds)
        ball = self.possession.update_unseen(predicted, motions)
        if held or ball is not None:
            self._moved_unseen = time
        # A robot that loses it leaves it here, and not where it was seen last.
        if self._moved_unseen > self._ball_seen:
            track.carry(ball or predicted, time)

    def _look_up(
        self,
        track: BallTrack,
        seen: BallDetection,
        time: float,
        camera: int,
        motions: Mapping[RobotId, RobotMotion],
    ) -> None:
        """Find out whether the detected ball was kicked, flies, or is in a robot's possession."""
        flights = self._flights
        kick = self._kick_watch.update(time, *track.place(seen.x, seen.y, camera), motions, self._sent)
        above = flights.at(time)
        if above is not None and above.z > ROBOT_HEIGHT:
            # Nobody kicks it: it is seen to pass them.
            kick = None
        if kick is not None:
            self.kicks.append(kick)
        if seen.tracked is None:
            near = near_robot(track.motion, motions)
            # A ball in the air is seen by each camera elsewhere: only the mean tells the camera's own offset.
            dx, dy = self._offsets.of(camera)
            flights.update(time, camera, seen.x - dx, seen.y - dy, kick, near)
        else:
            ball = seen.tracked
            flights.known(time, BallMotion(ball.x, ball.y, ball.vx, ball.vy, 0.0, ball.z, ball.vz))
        if flights.landed is not None:
            track.carry(flights.landed, time)
            flights.landed = None
        if flights.hop is None:
            self.possession.update(track.motion, motions)
        else:
            self.possession.holds = []

    def _limits_of(self, robot: RobotId) -> RobotLimits:
        return self._limits.get(robot, self.settings.limits)

    def _robot_at(self, robot: RobotId, time: float) -> RobotMotion:
        track = self._robots[robot]
        return predict_robot(track.motion, track.time, time, self._sent.get(robot, []), track.limits)

    def _ball_at(self, time: float, motions: Mapping[RobotId, RobotMotion]) -> BallMotion:
        track = self._ball
        if track is None:
            return BallMotion(0.0, 0.0)
        flying = self._flights.at(time)
        if flying is not None:
            return flying
        carried = self.possession.carried(motions)
        if carried is not None:
            return carried
        if time <= track.time:
            return track.motion
        ball = predict_ball(track.motion, time - track.time, self.settings.ball)
        return stop_at_robots(track.motion, ball, motions)


def _surest_first(seen: BallDetection | RobotDetection) -> float:
    return -seen.confidence
