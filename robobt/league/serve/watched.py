"""A served field in the live page, where one can drag its robots and the ball."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import ServedReferee
from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.live.hands import HeldObjects
from robobt.live.messages import Act, MoveBall, MoveRobot, TakeOff, robot_of
from robobt.live.server import Server
from robobt.live.stream import Stream
from robobt.match.recording import RecordedRobot, RecordingHeader
from robobt.match.recording.capture import Capture
from robobt.world.delay import MeasuredDelay
from robobt.world.state import Frame, RobotId

_STEPS_TO_DELAYS = 60
"""Number of steps after which the robots' delays are sent again."""


class WatchedField:
    """Shows a served field to a server's viewers; called after every step.

    Args:
        server: where it is watched.
        name: what the page calls it.
        referee: who decides the game, None without one.
        delays: returns how late each commanded robot obeys.
    """

    def __init__(
        self,
        server: Server,
        name: str,
        referee: ServedReferee | None,
        delays: Callable[[], Mapping[RobotId, MeasuredDelay | None]],
    ) -> None:
        self._server, self._name, self._referee, self._delays = server, name, referee, delays
        self._capture: Capture | None = None
        self._robots: frozenset[RobotId] = frozenset()
        self._grip = HeldObjects()
        self._ticks = 0
        server.tell(paused=False, speed=1.0, movable=True, orders=False, plays=[], over=None, span=None)

    def __call__(self, field: ServedField) -> None:
        """Carry out viewers' requests, and show the present state."""
        while not self._server.inbox.empty():
            self._do(self._server.inbox.get_nowait()[0], field)
        for move in self._grip.moves(field.time):
            self._move(move, field)
        truth = field.truth()
        if self._referee is not None:
            truth.game = self._referee.referee.game
        capture = self._captured(truth, field.period)
        for robot in field.kicked:
            capture.event("kick", truth.time, robot=robot)
        capture.tick(truth)
        self._ticks += 1
        if self._ticks % _STEPS_TO_DELAYS == 0:
            self._server.tell_delays(self._delays())

    def _captured(self, truth: Frame, period: float) -> Capture:
        """Return the capture of the field, a new one if a robot has appeared for the first time."""
        seen = self._robots.union(truth.robots())
        if self._capture is None or seen != self._robots:
            self._robots = seen
            robots = tuple([RecordedRobot(team=robot.team, number=robot.number) for robot in sorted(seen)])
            header = RecordingHeader(scenario=self._name, period=period, field=truth.field, robots=robots)
            self._capture = Capture(header)
            self._server.show(Stream(self._capture))
        return self._capture

    def _do(self, act: Act, field: ServedField) -> None:
        match act:
            case MoveBall() | MoveRobot():
                self._move(act, field)
                self._grip.follow(act, field.time)
            case TakeOff(robot=robot):
                self._grip.let_go(robot)
                self._tell(field.teleport(Teleport(robot_of(robot), present=False)))
            case _:
                self._tell("Others decide on a served field: here only robots and ball can be moved.")

    def _move(self, move: MoveBall | MoveRobot, field: ServedField) -> None:
        if isinstance(move, MoveBall):
            self._tell(field.teleport_ball(BallTeleport(move.x, move.y, move.vx, move.vy)))
        else:
            robot = robot_of(move.robot)
            self._tell(field.teleport(Teleport(robot, move.x, move.y, move.heading, present=True)))

    def _tell(self, problem: str | None) -> None:
        if problem is not None:
            self._server.say(problem)
