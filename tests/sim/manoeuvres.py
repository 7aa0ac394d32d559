"""What the real grSim did under open-loop commands, replayed in this simulator.

    python -m tests.sim.manoeuvres FILE [--preset grsim] [--seconds 1.5]

FILE holds, as gzipped JSON, ``{name: {t: [s], ball: [[x, y, z]], robots: {number: [[x, y, heading]]}}}``
of blue robots, seen 60 times a second from the first command on; the names say what was commanded.
"""

from __future__ import annotations

import argparse
import gzip
import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from math import cos, hypot, sin
from pathlib import Path

import numpy as np

from robobt.sim import SimWorld, preset
from robobt.world import DIVISION_B, Placement, RobotCommand, RobotId, Team
from robobt.world.geometry import FloatArray, wrap_angle

PERIOD = 1 / 60

Commands = Callable[[int], RobotCommand]
"""From the tick to the command of every robot."""


@dataclass(frozen=True)
class Deviation:
    """How far the replay was from the recording, at most.

    Attributes:
        name: of the manoeuvre.
        robot: the robots' positions [m].
        heading: the robots' headings [rad].
        ball: the ball's position [m].
    """

    name: str
    robot: float
    heading: float
    ball: float

    @property
    def robot_close(self) -> bool:
        """Whether the robots follow the recording: 40 mm and 0.1 rad."""
        return self.robot <= 0.04 and self.heading <= 0.1

    @property
    def close(self) -> bool:
        """Whether the replay follows the recording: the robots, and the ball within 60 mm."""
        return self.robot_close and self.ball <= 0.06


@dataclass(frozen=True)
class Manoeuvre:
    """A recorded manoeuvre.

    Attributes:
        name: says what was commanded.
        robots: (ticks, robots, 3) x, y, heading of blue 0, 1, ... [m, rad].
        ball: (ticks, 2) x, y [m].
    """

    name: str
    robots: FloatArray
    ball: FloatArray

    def start(self) -> Placement:
        """Return where everything was, the ball with the speed that it was given."""
        robots = {RobotId(Team.BLUE, i): (*pose,) for i, pose in enumerate(self.robots[0].tolist())}
        x, y = self.ball[0].tolist()
        return Placement(robots, (x, y, _ball_speed(self.name), 0.0))


def read_manoeuvres(file: Path) -> list[Manoeuvre]:
    """Read a file of manoeuvres, in the order of their names."""
    with gzip.open(file, "rt", encoding="utf-8") as stream:
        content = json.load(stream)
    found = []
    for name in sorted(content):
        rows = content[name]
        robots = np.array([rows["robots"][str(i)] for i in range(len(rows["robots"]))])
        found.append(Manoeuvre(name, robots.transpose(1, 0, 2), np.array(rows["ball"])[:, :2]))
    return found


def replay(manoeuvre: Manoeuvre, simulator: str = "grsim", seconds: float = 1.5) -> Deviation:
    """Give the same commands in this simulator and compare, for the first ``seconds``."""
    start = manoeuvre.start()
    world = SimWorld(DIVISION_B, dict.fromkeys(start.robots), preset(simulator), PERIOD)
    world.reset(start, seed=0)
    commands = commands_of(manoeuvre.name)
    robot = heading = ball = 0.0
    for tick in range(1, min(len(manoeuvre.ball), round(seconds / PERIOD) + 1)):
        world.act(dict.fromkeys(start.robots, commands(tick - 1)))
        frame = world.truth()
        for found, (x, y, angle) in zip(frame.own, manoeuvre.robots[tick].tolist(), strict=True):
            robot = max(robot, hypot(found.x - x, found.y - y))
            heading = max(heading, abs(wrap_angle(found.heading - angle)))
        x, y = manoeuvre.ball[tick].tolist()
        ball = max(ball, hypot(frame.ball.x - x, frame.ball.y - y))
    return Deviation(manoeuvre.name, robot, heading, ball)


def _ball_speed(name: str) -> float:
    """Return the speed with which the ball was placed, towards +x [m/s]."""
    if name.startswith(("side_bounce", "front_bounce")):
        return 2.0
    return 4.0 if name.startswith(("free_ball", "front_receive")) else 0.0


def commands_of(name: str) -> Commands:
    """Return what was commanded in the manoeuvre of that name.

    Raises:
        ValueError: a name that says nothing of the kind.
    """
    for pattern, build in _KINDS:
        found = re.fullmatch(pattern, name)
        if found:
            return build(*map(float, found.groups()))
    raise ValueError(f"no manoeuvre is known by the name {name!r}")


def _still(dribbler: bool = False) -> Commands:
    return lambda tick: RobotCommand(dribbler=dribbler)


def _turn_while(forward: float, turn: float) -> Commands:
    return lambda tick: RobotCommand(forward, omega=turn if tick >= 60 else 0.0)


_SIDES = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (0.0, 0.0))


def _square(speed: float, side: int) -> Commands:
    def commands(tick: int) -> RobotCommand:
        x, y = _SIDES[min(tick // side, 4)]
        return RobotCommand(speed * x, speed * y)

    return commands


def _ramped_square(acceleration: float) -> Commands:
    velocity = np.zeros(2)
    path: list[tuple[float, float]] = []
    for tick in range(600):
        path.append((float(velocity[0]), float(velocity[1])))
        change = 2.0 * np.array(_SIDES[min(tick // 90, 4)]) - velocity
        length = float(np.hypot(*change))
        if length > 0.0:
            velocity = velocity + change * min(acceleration * PERIOD / length, 1.0)
    return lambda tick: RobotCommand(*path[tick])


def _spin() -> Commands:
    return lambda tick: RobotCommand(omega=(8.0, -8.0, 0.0)[min(tick // 60, 2)])


def _circle() -> Commands:
    return lambda tick: RobotCommand(1.5, omega=1.5) if tick < 180 else RobotCommand()


def _kick_sideways() -> Commands:
    def commands(tick: int) -> RobotCommand:
        if tick < 30:
            return RobotCommand(0.1, dribbler=True)
        if tick < 78:
            return RobotCommand(vy=1.0, dribbler=True)
        return RobotCommand(vy=1.0, kick_speed=3.0)

    return commands


def _dribble_back(acceleration: float, top: float) -> Commands:
    def commands(tick: int) -> RobotCommand:
        if tick < 30:
            return RobotCommand(0.1, dribbler=True)
        return RobotCommand(-min(acceleration * (tick - 30) * PERIOD, top), dribbler=True)

    return commands


def _drift() -> Commands:
    def commands(tick: int) -> RobotCommand:
        if tick < 30:
            return RobotCommand(0.1, dribbler=True)
        heading = 2.0 * (tick - 30) * PERIOD
        return RobotCommand(0.5 * cos(heading), -0.5 * sin(heading), 2.0, dribbler=True)

    return commands


def _push() -> Commands:
    return lambda tick: RobotCommand(1.5 if tick < 72 else 0.0)


def _push_slow() -> Commands:
    return lambda tick: RobotCommand(max(1.2 - max(tick - 72, 0) * PERIOD, 0.0))


def _catch(speed: float) -> Commands:
    # The ball lies 0.9 m beyond where 4 m/s^2 reach the speed; the robot meets it some 0.1 m ahead.
    met = speed / 4 + 0.798 / speed + 0.12

    def commands(tick: int) -> RobotCommand:
        time = tick * PERIOD
        if time < met:
            return RobotCommand(speed, dribbler=True)
        return RobotCommand(max(speed - 3.0 * (time - met), 0.4), omega=-3.0, dribbler=True)

    return commands


def _catch_turn(turn: float) -> Commands:
    fast = RobotCommand(3.0, dribbler=True)
    return lambda tick: fast if tick < 63 else RobotCommand(1.2, omega=-turn, dribbler=True)


_KINDS: tuple[tuple[str, Callable[..., Commands]], ...] = (
    (r"turnwhile_v(\d)_w(\d+)", _turn_while),
    (r"square_2m_2mps", lambda: _square(2.0, 60)),
    (r"square_step_1mps", lambda: _square(1.0, 120)),
    (r"square_ramped_(\d)mss", _ramped_square),
    (r"circle_1.5mps_1.5radps", _circle),
    (r"spin_8radps", _spin),
    (r"kick3_moving_sideways", _kick_sideways),
    (r"dribble_back_1mss", lambda: _dribble_back(1.0, 1.5)),
    (r"dribble_back_0.4mss", lambda: _dribble_back(0.4, 1.0)),
    (r"turn_2radps_drift_with_ball", _drift),
    (r"side_bounce\w+", _still),
    (r"front_bounce\w+", _still),
    (r"front_receive\w+", lambda: _still(True)),
    (r"free_ball\w+", _still),
    (r"push_ball_1.5mps_no_dribbler", _push),
    (r"push_then_slow_brake_1mss", _push_slow),
    (r"head_on_1mps", lambda: lambda tick: RobotCommand(1.0)),
    (r"catch_turn(\d+)_ph\d", _catch_turn),
    (r"catch_(\d)_off\d+_ph\d+", _catch),
)


def table(deviations: list[Deviation]) -> str:
    """Return the deviations as lines of text, the close ones counted below."""
    lines = [f"{'manoeuvre':32} robot mm  rad    ball mm"]
    for found in deviations:
        mark = "" if found.close else "  beyond"
        lines.append(
            f"{found.name:32} {1000 * found.robot:8.0f}  {found.heading:5.3f} {1000 * found.ball:8.0f}{mark}"
        )
    close = sum(found.close for found in deviations)
    lines.append(f"within 40 mm, 0.1 rad and 60 mm: {close} of {len(deviations)}")
    return "\n".join(lines)


def main() -> None:
    """Print the table of a file."""
    parser = argparse.ArgumentParser(description="Compare the simulator with recorded manoeuvres")
    parser.add_argument("file", type=Path)
    parser.add_argument("--preset", default="grsim")
    parser.add_argument("--seconds", type=float, default=1.5)
    given = parser.parse_args()
    manoeuvres = read_manoeuvres(given.file)
    print(table([replay(one, given.preset, given.seconds) for one in manoeuvres]))


if __name__ == "__main__":
    main()
