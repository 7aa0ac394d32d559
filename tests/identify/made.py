"""Observations of play that is simulated with known robots, ball, delay and noise."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from math import pi
from pathlib import Path

import numpy as np

from robobt.identify.observations import Observations, without_repeats
from robobt.league.log.files import LogKind, LogWriter
from robobt.league.serve.cameras import Cameras
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.vision import write_vision
from robobt.sim import SimSettings, SimWorld
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

PERIOD = 1 / 60


class Watched:
    """A simulated world, and all that its cameras see and its robots are sent."""

    def __init__(
        self, limits: Mapping[RobotId, RobotLimits], settings: SimSettings, commanded: Team = Team.BLUE
    ) -> None:
        self.world = SimWorld(DIVISION_B, limits, settings, PERIOD)
        self.robots = tuple(sorted(limits))
        self._commanded = commanded
        self._times: list[float] = []
        self._ball: list[tuple[float, float]] = []
        self._poses: list[list[tuple[float, float, float]]] = []
        self._commands: list[list[tuple[float, ...]]] = []

    def tick(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Look, then send the commands."""
        frame = self.world.observe()
        robots = frame.robots()
        self._times.append(frame.time)
        self._ball.append(frame.ball.position)
        self._poses.append([(robots[it].x, robots[it].y, robots[it].heading) for it in self.robots])
        sent = {it: commands.get(it, RobotCommand()) for it in self.robots}
        self._commands.append(
            [
                (it.vx, it.vy, it.omega, it.kick_speed, it.kick_angle, float(bool(it.dribbler)))
                if robot.team is self._commanded
                else (np.nan,) * 6
                for robot, it in sent.items()
            ]
        )
        self.world.act(sent)

    def observations(self) -> Observations:
        """Return all that was seen and sent."""
        poses: FloatArray = np.array(self._poses)
        for robot in range(poses.shape[1]):
            poses[:, robot] = without_repeats(poses[:, robot])
        ball = without_repeats(np.array(self._ball))
        times, commands = np.array(self._times), np.array(self._commands)
        return Observations(DIVISION_B, self.robots, times, ball, poses, times, commands)


def driven(limits: RobotLimits, settings: SimSettings, seconds: float = 30.0, seed: int = 0) -> Observations:
    """Return what cameras saw of blue 0, which was sent here and there, and of yellow 0, which was so too."""
    watched = Watched({RobotId(team, 0): limits for team in Team}, settings)
    places = {RobotId(Team.BLUE, 0): (-2.5, 0.0, 0.0), RobotId(Team.YELLOW, 0): (2.5, 0.0, 0.0)}
    watched.world.reset(Placement(robots=places, ball=(0.0, 2.9, 0.0, 0.0)), seed)
    rng = np.random.default_rng(seed)
    targets = {robot: place[:2] for robot, place in places.items()}
    turns = dict.fromkeys(places, 0.0)
    for tick in range(round(seconds / PERIOD)):
        if tick % 50 == 0:
            for robot, (x, _, _) in places.items():
                targets[robot] = (x + float(rng.uniform(-1.5, 1.5)), float(rng.uniform(-2.5, 2.5)))
                turns[robot] = float(rng.choice([0.0, 0.0, rng.uniform(-0.5, 0.5) * pi]))
        commands = {}
        for robot, state in watched.world.truth().robots().items():
            dx, dy = targets[robot][0] - state.x, targets[robot][1] - state.y
            away = max(float(np.hypot(dx, dy)), 1e-9)
            # As fast as it can still stop.
            speed = min(4.0, float(np.sqrt(1.6 * limits.braking * away)))
            c, s = np.cos(state.heading), np.sin(state.heading)
            vx, vy = speed * dx / away, speed * dy / away
            commands[robot] = RobotCommand(float(c * vx + s * vy), float(c * vy - s * vx), turns[robot])
        watched.tick(commands)
    return watched.observations()


def kicked(settings: SimSettings, kicks: int = 12, seed: int = 0) -> Observations:
    """Return what cameras saw of a ball that blue 0 kicked again and again, at different speeds."""
    robot = RobotId(Team.BLUE, 0)
    watched = Watched({robot: settings.limits}, settings)
    rng = np.random.default_rng(seed)
    watched.world.reset(Placement(robots={robot: (-4.0, 0.0, 0.0)}, ball=(-3.9, 0.0, 0.0, 0.0)), seed)
    for _ in range(kicks):
        angle = float(rng.uniform(-0.4, 0.4))
        watched.world.put_robot(robot, -4.0, 0.0, angle)
        place = -4.0 + 0.0975 * float(np.cos(angle)), 0.0975 * float(np.sin(angle))
        watched.world.put_ball(*place, 0.0, 0.0)
        speed = float(rng.uniform(1.5, 3.5))
        for tick in range(round(2.5 / PERIOD)):
            asked = speed if 10 <= tick < 40 else 0.0
            watched.tick({robot: RobotCommand(0.0, 0.0, 0.0, asked)})
    return watched.observations()


def chipped(settings: SimSettings, chips: int = 3, seed: int = 0) -> Observations:
    """Return what cameras saw of a ball that blue 0 chipped again and again, at different speeds."""
    watched = Watched({ROBOT: settings.limits}, settings)
    for commands in chips_of(watched.world, chips, seed):
        watched.tick(commands)
    return watched.observations()


ROBOT = RobotId(Team.BLUE, 0)


def chips_of(world: SimWorld, chips: int, seed: int = 0) -> Iterator[dict[RobotId, RobotCommand]]:
    """Yield the commands of blue 0 that chips again and again; each has to be carried out before the next."""
    rng = np.random.default_rng(seed)
    world.reset(Placement(robots={ROBOT: (-4.0, 0.0, 0.0)}, ball=(-3.9, 0.0, 0.0, 0.0)), seed)
    for _ in range(chips):
        angle = float(rng.uniform(-0.4, 0.4))
        world.put_robot(ROBOT, -4.0, 0.0, angle)
        world.put_ball(-4.0 + 0.0975 * float(np.cos(angle)), 0.0975 * float(np.sin(angle)), 0.0, 0.0)
        speed = float(rng.uniform(3.0, 4.5))
        for tick in range(round(2.0 / PERIOD)):
            asked = speed if 10 <= tick < 40 else 0.0
            yield {ROBOT: RobotCommand(0.0, 0.0, 0.0, asked, kick_angle=CHIP_ANGLE)}


def pushed(settings: SimSettings, kicks: int, seed: int = 0) -> Observations:
    """Return what cameras saw of a ball that blue 0 dribbled ahead, or held every third time, then kicked."""
    watched = Watched({ROBOT: settings.limits}, settings)
    rng = np.random.default_rng(seed)
    watched.world.reset(Placement(robots={ROBOT: (-4.0, 0.0, 0.0)}, ball=(-3.9, 0.0, 0.0, 0.0)), seed)
    for number in range(kicks):
        watched.world.put_robot(ROBOT, -4.0, 0.0, 0.0)
        watched.world.put_ball(-4.0 + 0.0975, 0.0, 0.0, 0.0)
        drives, speed = float(rng.uniform(0.6, 1.4)) * (number % 3 > 0), float(rng.uniform(3.0, 4.5))
        for tick in range(round(2.5 / PERIOD)):
            kick = speed if 50 <= tick < 70 else 0.0
            ahead = min(drives, 0.03 * tick) if tick < 70 else 0.0
            watched.tick({ROBOT: RobotCommand(ahead, 0.0, 0.0, kick, dribbler=tick < 60)})
    return watched.observations()


def logged(path: Path, world: SimWorld, play: Iterable[Mapping[RobotId, RobotCommand]], cameras: int) -> None:
    """Write a league log of play in a world as this many cameras over it see it."""
    over = Cameras(world.field, world.settings.realism, cameras, np.random.default_rng(0), PERIOD)
    with LogWriter(path) as log:
        geometry = write_geometry(world.field, list(over.calibrated.values()))
        for commands in play:
            for frame in over.capture(world.truth(), world.time, world.time):
                log.write(round(world.time * 1e9), LogKind.VISION, write_vision(frame, geometry))
            world.act(commands)


def touched(settings: SimSettings, touches: int, seed: int = 0) -> Observations:
    """Return what cameras saw of balls that rolled to blue 0 from aside, kicked at the first touch."""
    robot = RobotId(Team.BLUE, 0)
    watched = Watched({robot: settings.limits}, settings)
    rng = np.random.default_rng(seed)
    watched.world.reset(Placement(robots={robot: (-3.0, 0.0, 0.0)}, ball=(0.0, 2.0, 0.0, 0.0)), seed)
    for _ in range(touches):
        watched.world.put_robot(robot, -3.0, 0.0, 0.0)
        angle = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.3, 0.7))
        c, s = float(np.cos(angle)), float(np.sin(angle))
        watched.world.put_ball(-2.9 + 1.5 * c, 1.5 * s, -3.5 * c, -3.5 * s)
        speed = float(rng.uniform(2.0, 3.5))
        for _ in range(round(2.0 / PERIOD)):
            watched.tick({robot: RobotCommand(0.0, 0.0, 0.0, speed)})
    return watched.observations()
