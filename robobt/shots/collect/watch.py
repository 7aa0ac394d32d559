"""Records shots: a world that stores the scene at the time of the kick."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from math import atan2, cos, hypot, sin

from robobt.match.ends import Outcome
from robobt.match.loop import MatchLoop
from robobt.match.scenario.scenario import Scenario
from robobt.shots.collect.plan import Attempt, Section
from robobt.shots.data.schema import Row
from robobt.skills.store import Shot, Store
from robobt.world.command import RobotCommand
from robobt.world.geometry import distance, to_robot_frame, wrap_angle
from robobt.world.protocol import Placement, World, WrappedWorld
from robobt.world.state import Frame, RobotId, RobotState
from robobt.worlds import sim_world


class LateWorld(WrappedWorld):
    """Holds back the commands of one robot, and starts with robots on their way.

    Args:
        world: where the commands go.
        robot: whose commands are held back.
        delay: how late they take effect [s]; between two commands, in proportion.
        period: control period [s].
        velocities: (vx, vy) at the start of the robots that are not at rest [m/s].
    """

    def __init__(
        self,
        world: World,
        robot: RobotId,
        delay: float,
        period: float,
        velocities: Mapping[RobotId, tuple[float, float]],
    ) -> None:
        super().__init__(world)
        self._robot = robot
        self._velocities = dict(velocities)
        ticks = delay / period
        self._share = ticks % 1.0
        self._held: deque[RobotCommand] = deque(maxlen=int(ticks) + 2)

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`World.reset`; the robot goes on as it moves until its first command is due."""
        vx, vy = to_robot_frame(
            *self._velocities.get(self._robot, (0.0, 0.0)), placement.robots[self._robot][2]
        )
        self._held.clear()
        self._held.extend(RobotCommand(vx, vy) for _ in range(int(self._held.maxlen or 0)))
        self.world.reset(replace(placement, velocities=self._velocities), seed)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`World.act`."""
        newest = commands.get(self._robot, RobotCommand())
        self._held.append(newest)
        older, newer = self._held[0], self._held[1]
        late = RobotCommand(
            older.vx * self._share + newer.vx * (1.0 - self._share),
            older.vy * self._share + newer.vy * (1.0 - self._share),
            older.omega * self._share + newer.omega * (1.0 - self._share),
            newest.kick_speed,
            newest.kick_trigger,
            newest.dribbler,
        )
        self.world.act({**commands, self._robot: late})


_LEAVING_SPEED_SHARE = 0.5
"""A ball that leaves with this share of the kick's speed has been kicked."""

_OUTCOMES = {Outcome.GOAL_BLUE: "goal", Outcome.SAVED: "saved", Outcome.OUT: "wide", Outcome.REST: "stopped"}


class WatchedWorld(WrappedWorld):
    """Passes everything on to a world and keeps the last shot of one blue robot.

    ``store`` is the shooter's, which knows the target; ``shot`` has the last shot's columns by name, None
    before the first.
    """

    def __init__(self, world: World, shooter: RobotId) -> None:
        super().__init__(world)
        self._shooter = shooter
        self.store: Store | None = None
        self.shot: Row | None = None

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Pass the commands on, and look whether one of them was the kick."""
        order = commands.get(self._shooter)
        if order is None or order.kick_speed <= 0.0:
            self.world.act(commands)
            return
        before = self.world.truth()
        aimed = None if self.store is None else self.store.shot
        self.world.act(commands)
        me = before.robot(self._shooter.number)
        if aimed is None or me is None:
            return
        after = self.world.truth()
        away = _speed_away(me, after) - _speed_away(me, before)
        if away > _LEAVING_SPEED_SHARE * order.kick_speed or _stopped_at_once(before, after, self._shooter):
            self.shot = _scene(before, after, me, aimed, self._shooter)


def take_shot(attempt: Attempt, trial: int) -> tuple[Row | None, float]:
    """Play one trial with one attacker, blue's first robot; return its last shot and how long it lasted [s].

    The shot is recorded columns of the table of shots, None when it took none.
    """
    shooter = next(iter(attempt.scenario.robots))[0]
    keeper = attempt.scenario.robots.yellow[0].number
    watched: list[WatchedWorld] = []

    def factory(played: Scenario) -> World:
        world = sim_world(played)
        if attempt.delay > 0.0:
            goalkeeper = RobotId(shooter.team.other, keeper)
            world = LateWorld(world, goalkeeper, attempt.delay, played.period, attempt.velocities)
        watched.append(WatchedWorld(world, shooter))
        return watched[0]

    with MatchLoop(attempt.scenario, attempt.seed, factory, trial=trial) as match:
        world = watched[0]
        saved = False
        world.store = next(player.store for player in match.players if player.robot == shooter)
        while match.tick():
            if attempt.section is not None and world.shot is None and _outside(attempt.section, world.store):
                break
            if attempt.delay > 0.0 and world.shot is not None and _turned_back(world.truth(), shooter):
                saved = True
                break
        result = match.result()
        touched = world.truth().last_touch
    shot = world.shot
    if shot is not None:
        outcome = "saved" if saved else _OUTCOMES.get(Outcome(result.outcome), result.outcome)
        if outcome in ("wide", "stopped") and touched is not None and touched.team is not shooter.team:
            outcome = "blocked"
        shot.update(attempt.labels)
        shot["outcome"], shot["success"] = outcome, int(outcome == "goal")
        shot["trial"] = trial
    return shot, result.time


def _turned_back(frame: Frame, shooter: RobotId) -> bool:
    """Return whether an opponent has turned the ball back, so that its further way does not count."""
    touched = frame.last_touch
    return touched is not None and touched.team is not shooter.team and frame.ball.vx <= 0.0


def _outside(section: Section, store: Store) -> bool:
    (x0, x1), (y0, y1) = section
    ball = store.frame.ball
    return not (x0 <= ball.x <= x1 and y0 <= ball.y <= y1)


def _scene(before: Frame, after: Frame, me: RobotState, shot: Shot, shooter: RobotId) -> Row:
    ball, mates, opponents = before.ball, before.teammates(me.id), before.opponents
    row: Row = {
        "time": before.time,
        "robot_x": me.x,
        "robot_y": me.y,
        "robot_heading": wrap_angle(me.heading),
        "robot_field_vx": me.vx,
        "robot_field_vy": me.vy,
        "robot_omega": me.omega,
        "ball_x": ball.x,
        "ball_y": ball.y,
        "ball_vx": ball.vx,
        "ball_vy": ball.vy,
        "target_x": shot.target[0],
        "target_y": shot.target[1],
        "opponents_x": [robot.x for robot in opponents],
        "opponents_y": [robot.y for robot in opponents],
        "opponents_heading": [wrap_angle(robot.heading) for robot in opponents],
        "opponents_vx": [robot.vx for robot in opponents],
        "opponents_vy": [robot.vy for robot in opponents],
        "opponents_omega": [robot.omega for robot in opponents],
        "mates_x": [robot.x for robot in mates],
        "mates_y": [robot.y for robot in mates],
        "mates_vx": [robot.vx for robot in mates],
        "mates_vy": [robot.vy for robot in mates],
    }
    if after.last_touch == shooter:
        # What the kick did is seen while nobody else has touched the ball.
        aim = atan2(shot.target[1] - ball.y, shot.target[0] - ball.x)
        row["kick_speed"] = after.ball.speed
        row["kick_error"] = wrap_angle(atan2(after.ball.vy, after.ball.vx) - aim)
    return row


def _speed_away(me: RobotState, frame: Frame) -> float:
    return frame.ball.vx * cos(me.heading) + frame.ball.vy * sin(me.heading)


def _stopped_at_once(before: Frame, after: Frame, shooter: RobotId) -> bool:
    """Return whether another robot is so near that the kicked ball met it within the tick."""
    toucher = after.last_touch
    return (
        toucher is not None
        and toucher != shooter
        and toucher != before.last_touch
        and distance(before.ball.position, after.ball.position) > 0.05
        and hypot(after.ball.vx, after.ball.vy) > 0.0
    )
