"""Whether the cameras' picture answers to the commands: robots that nobody sees move are not driven on.

No sockets and no clock: all times are arguments, on the field's clock.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from math import hypot, inf

from robobt.league.wire.notices import Notices
from robobt.league.wire.vision import CameraFrame
from robobt.world.command import RobotCommand
from robobt.world.geometry import wrap_angle
from robobt.world.state import RobotId

_BLIND = 0.2
"""Without any of the commanded robots in a frame for this long, all are told to stand [s]."""

_PATIENCE = 0.35
"""A robot that is commanded to move, with nothing seen to move, is told to stand after this time [s]."""

_COMMANDED, _COMMANDED_TURN = 0.06, 0.3
"""What its commands have to add up to in that time: a robot that dithers stays where it is [m, rad]."""

_MOVED, _TURNED = 0.015, 0.1
"""What is seen to move by more than this moves; less may be noise [m, rad]."""

_RETRY, _TRIAL = 5.0, 0.3
"""A robot that was told to stand tries again after this time, for so long [s] ..."""

_TRIAL_SPEED, _TRIAL_TURN = 0.2, 1.0
"""... and no faster than this, as it may go where nobody sees it [m/s, rad/s]."""

_Pose = tuple[float, float, float]


@dataclass(slots=True)
class _Camera:
    """What a camera sees, since when exactly that, and when it was last heard [s]."""

    content: list[object]
    changed: float
    heard: float


@dataclass(slots=True, frozen=True)
class _Stand:
    """Since when a robot stands [s], and whether because its cameras show no change at all."""

    since: float
    frozen: bool


@dataclass(slots=True)
class _Demand:
    """What a robot was commanded of late, newest last, and since when without a pause [s]."""

    since: float = inf
    commands: deque[tuple[float, RobotCommand]] = field(default_factory=deque)


class PictureWatch:
    """Lets robots stand whose commands have no effect that a camera shows.

    A live camera's detections differ from frame to frame, if only by noise. A robot is told to stand when all
    cameras that see it show exactly the same throughout, or when nothing on the field moves. One
    that is blocked while others move drives on. It may move again when the picture does; every 5 s it tries.
    """

    def __init__(self, notices: Notices) -> None:
        self._notices = notices
        self.clear()

    def clear(self) -> None:
        """Begin anew, as after robots have been put elsewhere."""
        self._cameras: dict[int, _Camera] = {}
        self._seen: dict[RobotId, dict[int, float]] = {}
        self._anchors: dict[tuple[int, RobotId | None], _Pose] = {}
        self._demands: dict[RobotId, _Demand] = {}
        self._standing: dict[RobotId, _Stand] = {}
        self._moved = self._heard = -inf

    def see(self, frame: CameraFrame, time: float) -> None:
        """Take in a frame that was used at a time [s]."""
        content: list[object] = [(it.robot, it.x, it.y, it.heading) for it in frame.robots]
        content += [(it.x, it.y) for it in frame.balls]
        camera = self._cameras.get(frame.camera)
        if camera is None:
            self._cameras[frame.camera] = _Camera(content, time, time)
        else:
            if content != camera.content:
                camera.content, camera.changed = content, time
            camera.heard = time
        if self._moved == -inf:
            self._moved = time
        self._heard = time
        for it in frame.robots:
            self._seen.setdefault(it.robot, {})[frame.camera] = time
            self._follow((frame.camera, it.robot), (it.x, it.y, it.heading or 0.0), time)
        for ball in frame.balls[:1]:
            self._follow((frame.camera, None), (ball.x, ball.y, 0.0), time)

    def checked(self, commands: Mapping[RobotId, RobotCommand], time: float) -> dict[RobotId, RobotCommand]:
        """Return the commands that may be sent at a time [s]; call it for all that are to be sent."""
        seen = max((max(self._seen[it].values()) for it in commands if it in self._seen), default=-inf)
        if time - seen > _BLIND:
            commands = {robot: RobotCommand() for robot in commands}
        return {robot: self._checked(robot, command, time) for robot, command in commands.items()}

    def _checked(self, robot: RobotId, command: RobotCommand, time: float) -> RobotCommand:
        demand = self._demands.setdefault(robot, _Demand())
        moves = _moves(command)
        stand = self._standing.get(robot)
        if stand is not None and self._answered(robot, stand):
            del self._standing[robot]
            demand.since, stand = inf, None
        if stand is None:
            self._note(demand, command, time)
            if not (moves and self._unanswered(demand, time) and self._still(robot)):
                return command
            stand = self._standing[robot] = _Stand(time, self._frozen(robot))
            self._notices.tell(
                "picture",
                f"{robot} is commanded to move, but vision shows no motion: either vision is frozen or the "
                "robots receive no commands. These robots are stopped until vision shows motion; "
                "check vision and radio",
            )
        if not moves:
            return command
        if (time - stand.since) % (_RETRY + _TRIAL) < _RETRY:
            return RobotCommand()
        share = min(1.0, _TRIAL_SPEED / max(_TRIAL_SPEED, hypot(command.vx, command.vy)))
        turn = min(max(command.omega, -_TRIAL_TURN), _TRIAL_TURN)
        return RobotCommand(command.vx * share, command.vy * share, turn)

    def _note(self, demand: _Demand, command: RobotCommand, time: float) -> None:
        """Take note of what a robot is commanded."""
        if not _moves(command):
            demand.since = inf
            demand.commands.clear()
            return
        demand.since = min(demand.since, time)
        demand.commands.append((time, command))
        while demand.commands[0][0] < time - _PATIENCE:
            demand.commands.popleft()

    def _unanswered(self, demand: _Demand, time: float) -> bool:
        """Return whether a robot should have moved by now."""
        if time - demand.since < _PATIENCE:
            return False
        x = y = turn = 0.0
        times = [at for at, _ in demand.commands]
        for (at, command), until in zip(demand.commands, [*times[1:], time], strict=True):
            x += command.vx * (until - at)
            y += command.vy * (until - at)
            turn += command.omega * (until - at)
        return hypot(x, y) > _COMMANDED or abs(turn) > _COMMANDED_TURN

    def _still(self, robot: RobotId) -> bool:
        """Return whether nothing on the field moves, or nothing at all changes where a robot is seen."""
        return self._heard - self._moved >= _PATIENCE or self._frozen(robot)

    def _frozen(self, robot: RobotId) -> bool:
        cameras = self._cameras_of(robot)
        return bool(cameras) and all(it.heard - it.changed >= _PATIENCE for it in cameras)

    def _answered(self, robot: RobotId, stand: _Stand) -> bool:
        """Return whether the picture has moved since a robot was told to stand."""
        if stand.frozen:
            return any(it.changed > stand.since for it in self._cameras_of(robot))
        return self._moved > stand.since

    def _cameras_of(self, robot: RobotId) -> list[_Camera]:
        """Return the cameras that see a robot."""
        seen = self._seen.get(robot, {})
        return [self._cameras[it] for it, time in seen.items() if self._heard - time < _PATIENCE]

    def _follow(self, what: tuple[int, RobotId | None], pose: _Pose, time: float) -> None:
        """Find out whether something has moved."""
        x, y, heading = self._anchors.setdefault(what, pose)
        if hypot(pose[0] - x, pose[1] - y) > _MOVED or abs(wrap_angle(pose[2] - heading)) > _TURNED:
            self._anchors[what] = pose
            self._moved = time


def _moves(command: RobotCommand) -> bool:
    return bool(command.vx or command.vy or command.omega)
