"""Frames by hand, and one skill ticked on them."""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.skills.store import Pass, Shot, Store
from robobt.testing import frame, robot
from robobt.tree import Behaviour, Status, TreeRunner
from robobt.world import Frame, RobotCommand, RobotState
from robobt.world.geometry import Point, wrap_angle


class Alone:
    """One skill or tree on hand-made frames.

    Attributes:
        store: the store it works on; fill it before a tick, read it after.
        command: what the last tick decided.
    """

    def __init__(self, tree: Behaviour, target: Point | None = None) -> None:
        me = robot()
        self.tree = tree
        self.store = Store(frame(me), me, target=target)
        self._runner = TreeRunner(tree, self.store)

    @property
    def command(self) -> RobotCommand:
        return self.store.command

    def tick(self, frame: Frame, number: int = 0) -> Status:
        """One tick of robot ``number`` on a frame; an exception in the tree is raised as an error."""
        me = frame.robot(number)
        assert me is not None
        self.store.frame, self.store.me = frame, me
        self.store.command = RobotCommand()
        status = self._runner.tick()
        assert self._runner.error is None, self._runner.error
        return status

    def stop(self) -> None:
        self._runner.stop()


def shot_at(x: float, y: float, tolerance: float = 0.05) -> Shot:
    return Shot((x, y), tolerance, 1.0)


def pass_to(receiver: int, x: float, y: float, speed: float = 4.0) -> Pass:
    return Pass(receiver, (x, y), speed, 1.0)


def moved(me: RobotState, command: RobotCommand, period: float) -> RobotState:
    """``me`` one period later, driven by ``command`` within its limits: kinematics without contacts."""
    limits, steps = me.limits, 5
    x, y, heading, vx, vy, omega = me.x, me.y, me.heading, me.vx, me.vy, me.omega
    dt = period / steps
    for _ in range(steps):
        c, s = cos(heading), sin(heading)
        dx, dy = c * command.vx - s * command.vy - vx, s * command.vx + c * command.vy - vy
        change = hypot(dx, dy)
        if change > 0.0:
            ahead, aside = (c * dx + s * dy) / change, (c * dy - s * dx) / change
            if dx * vx + dy * vy < 0.0:
                most = (limits.braking, limits.lateral_braking)
            else:
                most = (limits.acceleration, limits.lateral_acceleration)
            share = min(1.0, dt / sqrt((ahead / most[0]) ** 2 + (aside / most[1]) ** 2) / change)
            vx, vy = vx + dx * share, vy + dy * share
        turn = min(limits.max_turn, max(-limits.max_turn, command.omega)) - omega
        step = limits.turn_acceleration * dt
        omega += min(step, max(-step, turn))
        x, y, heading = x + vx * dt, y + vy * dt, wrap_angle(heading + omega * dt)
    return RobotState(me.id, x, y, heading, vx, vy, omega, me.ball_contact, limits)
