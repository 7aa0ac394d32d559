"""Checks that robots visibly move as commanded; robots that do not are stopped.

No sockets and no clock: all times are arguments, on the field's clock.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import hypot, inf

from robobt.league.wire.notices import Notices
from robobt.league.wire.vision import CameraFrame
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.state import RobotId

_BLIND = 0.2
"""Time without any commanded robot in a frame after which all are commanded to stop [s]."""

_STANDSTILL_TIMEOUT = 0.35
"""Time after which a robot commanded to move is stopped if nothing is seen to move [s]."""

_DUEL = 2.0
"""That time while others move: vision is then probably live, and the robot blocked in a duel [s]."""

_COMMANDED, _COMMANDED_TURN = 0.06, 0.3
"""Least sum of its commands since then, because a robot with alternating commands stays in place [m, rad]."""

_LEAST_MOTION, _LEAST_TURN = 0.015, 0.1
"""Least observed movement that is not noise [m, rad]."""

_RETRY_PAUSE, _RETRY_TIME = 5.0, 0.3
"""Time after which a stopped robot tries again, and duration of the trial [s] ..."""

_TRIAL_SPEED, _TRIAL_TURN = 0.2, 1.0
"""... and its top speed, because it may drive out of sight [m/s, rad/s]."""

_LEVER = 0.2
"""Speed that counts as much as a turning rate of 1 rad/s where commands are compared [m]."""

_Pose = tuple[float, float, float]


@dataclass(slots=True)
class _CameraView:
    """What a camera sees, since when exactly that, and when it was last heard [s]."""

    content: list[object]
    changed: float
    heard: float


@dataclass(slots=True)
class _Stand:
    """Since when a robot stands [s], whether because its cameras show no change at all, and its trials."""

    since: float
    frozen: bool
    tried: list[RobotCommand]
    ended: float

    def tries(self, trial: RobotCommand, time: float) -> bool:
        """Return whether a trial may be sent now: every 5 s, and at once where it is unlike all others."""
        new = all(_unlike(trial, it) for it in self.tried)
        if new:
            self.tried.append(trial)
        if new or time - self.ended >= _RETRY_PAUSE:
            self.ended = time + _RETRY_TIME
        return time < self.ended


@dataclass(slots=True)
class _Demand:
    """What a robot was commanded since it was last seen to move, or began to be commanded to."""

    since: float = inf
    x: float = 0.0
    y: float = 0.0
    turn: float = 0.0
    latest: float = -inf

    def begin(self, time: float) -> None:
        """Reset the sums."""
        self.since, self.x, self.y, self.turn = time, 0.0, 0.0, 0.0

    def add(self, command: RobotCommand, time: float) -> None:
        """Add a command to the sums for the time since the one before it."""
        if not _moves(command):
            self.since = inf
            return
        if self.since == inf:
            self.begin(time)
        else:
            step = time - self.latest
            self.x += command.vx * step
            self.y += command.vy * step
            self.turn += command.omega * step
        self.latest = time

    def unanswered(self, time: float) -> bool:
        """Return whether the robot should have been seen to move by now."""
        enough = hypot(self.x, self.y) > _COMMANDED or abs(self.turn) > _COMMANDED_TURN
        return enough and time - self.since >= _STANDSTILL_TIMEOUT


class PictureWatch:
    """Lets robots stand whose commands have no effect that a camera shows.

    A live camera's detections differ from frame to frame, if only by noise. A robot is stopped when all
    cameras that see it keep showing exactly the same, or when no commanded robot moves: at once if nothing
    else moves either, later if the ball or others move. A robot that is blocked while a commanded team-mate
    moves keeps driving. A stopped robot may move again when the others do; it tries every 5 s, and at once
    when its command changes direction.
    """

    def __init__(self, notices: Notices) -> None:
        self._notices = notices
        self.clear()

    def clear(self) -> None:
        """Reset, after robots have been placed elsewhere."""
        self._cameras: dict[int, _CameraView] = {}
        self._seen: dict[RobotId, dict[int, float]] = {}
        self._anchors: dict[tuple[int, RobotId | None], _Pose] = {}
        self._demands: dict[RobotId, _Demand] = {}
        self._standing: dict[RobotId, _Stand] = {}
        self._moved = self._followed = self._heard = -inf

    def see(self, frame: CameraFrame, time: float) -> None:
        """Take in a frame that was used at a time [s]."""
        content: list[object] = [(it.robot, it.x, it.y, it.heading) for it in frame.robots]
        content += [(it.x, it.y) for it in frame.balls]
        camera = self._cameras.get(frame.camera)
        if camera is None:
            self._cameras[frame.camera] = _CameraView(content, time, time)
        else:
            if content != camera.content:
                camera.content, camera.changed = content, time
            camera.heard = time
        self._heard = time
        for it in frame.robots:
            self._seen.setdefault(it.robot, {})[frame.camera] = time
            demand = self._demands.get(it.robot)
            moved = self._follow((frame.camera, it.robot), (it.x, it.y, it.heading or 0.0), time)
            if moved and demand is not None and demand.since < inf:
                self._followed = time
                demand.begin(time)
        for ball in frame.balls[:1]:
            self._follow((frame.camera, None), (ball.x, ball.y, 0.0), time)

    def checked(self, commands: Mapping[RobotId, RobotCommand], time: float) -> dict[RobotId, RobotCommand]:
        """Return the commands that may be sent at a time [s]; call it for all that are to be sent."""
        seen = max((max(self._seen[it].values()) for it in commands if it in self._seen), default=-inf)
        if time - seen > _BLIND:
            commands = {robot: RobotCommand() for robot in commands}
        self._demands = {robot: self._demands.get(robot) or _Demand() for robot in commands}
        return {robot: self._checked(robot, command, time) for robot, command in commands.items()}

    def _checked(self, robot: RobotId, command: RobotCommand, time: float) -> RobotCommand:
        demand = self._demands[robot]
        demand.add(command, time)
        moves = _moves(command)
        stand = self._standing.get(robot)
        if stand is not None and self._answered(robot, stand):
            del self._standing[robot]
            stand = None
            if moves:
                demand.begin(time)
        if stand is None:
            if not (moves and demand.unanswered(time) and self._still(robot, demand)):
                return command
            stand = self._standing[robot] = _Stand(time, self._frozen(robot), [_trial(command)], time)
            self._notices.tell(
                "picture",
                f"{robot} is commanded to move, but vision shows no motion: either vision is frozen or the "
                "robots receive no commands. These robots are stopped until vision shows motion; "
                "check vision and radio",
            )
        if not moves:
            return command
        trial = _trial(command)
        return trial if stand.tries(trial, time) else RobotCommand(dribbler=command.dribbler)

    def _still(self, robot: RobotId, demand: _Demand) -> bool:
        """Return whether no commanded robot moves, or nothing at all changes where a robot is seen."""
        patience = _DUEL if self._heard - self._moved < _STANDSTILL_TIMEOUT else _STANDSTILL_TIMEOUT
        return self._heard - max(self._followed, demand.since) >= patience or self._frozen(robot)

    def _frozen(self, robot: RobotId) -> bool:
        cameras = self._cameras_of(robot)
        return bool(cameras) and all(it.heard - it.changed >= _STANDSTILL_TIMEOUT for it in cameras)

    def _answered(self, robot: RobotId, stand: _Stand) -> bool:
        """Return whether the picture, or a commanded robot, has moved since a robot was stopped."""
        if stand.frozen:
            return any(it.changed > stand.since for it in self._cameras_of(robot))
        return self._followed > stand.since

    def _cameras_of(self, robot: RobotId) -> list[_CameraView]:
        """Return the cameras that see a robot."""
        seen = self._seen.get(robot, {})
        return [self._cameras[it] for it, time in seen.items() if self._heard - time < _STANDSTILL_TIMEOUT]

    def _follow(self, what: tuple[int, RobotId | None], pose: _Pose, time: float) -> bool:
        """Find out whether something has moved."""
        x, y, heading = self._anchors.setdefault(what, pose)
        if (
            hypot(pose[0] - x, pose[1] - y) > _LEAST_MOTION
            or abs(wrap_angle(pose[2] - heading)) > _LEAST_TURN
        ):
            self._anchors[what] = pose
            self._moved = time
            return True
        return False


def _moves(command: RobotCommand) -> bool:
    return bool(command.vx or command.vy or command.omega)


def _trial(command: RobotCommand) -> RobotCommand:
    """Return a command made slow, and without a kick."""
    share = min(1.0, _TRIAL_SPEED / max(_TRIAL_SPEED, hypot(command.vx, command.vy)))
    turn = min(max(command.omega, -_TRIAL_TURN), _TRIAL_TURN)
    return RobotCommand(command.vx * share, command.vy * share, turn, dribbler=command.dribbler)


def _unlike(new: RobotCommand, old: RobotCommand) -> bool:
    """Return whether a command differs from an old one by more than its size: by 60 degrees, if as fast."""
    change = hypot(new.vx - old.vx, new.vy - old.vy, _LEVER * (new.omega - old.omega))
    return change > hypot(old.vx, old.vy, _LEVER * old.omega)
