"""A small vocabulary for tests that play: what eventually happens, what always holds.

trial = Trial({blue(1): my_tree()}, {blue(1): (-1, 0, 0)}, ball=(0, 0))
trial.run(5.0, eventually("the ball is in the goal", goal_for_us()),
               always("inside the field", inside_the_field))
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from robobt.sim import SimSettings, SimWorld, preset
from robobt.skills.store import Store, TeamStore
from robobt.tree import Behaviour, TreeRunner
from robobt.world import (
    DIVISION_B,
    BallState,
    FieldGeometry,
    Frame,
    Placement,
    RobotCommand,
    RobotId,
    RobotLimits,
    Team,
)
from robobt.world.rules import scorer

Pose = tuple[float, float, float]
Predicate = Callable[[Frame], bool]


@dataclass(frozen=True)
class Statement:
    """Something to hold of the frames of a trial, all seen from blue's side."""

    kind: str
    what: str
    holds: Predicate


def eventually(what: str, holds: Predicate) -> Statement:
    """At some frame it holds; the run ends early once all such statements did."""
    return Statement("eventually", what, holds)


def always(what: str, holds: Predicate) -> Statement:
    """At every frame it holds."""
    return Statement("always", what, holds)


def never(what: str, holds: Predicate) -> Statement:
    """At no frame it holds."""
    return Statement("always", f"not: {what}", lambda frame: not holds(frame))


def blue(number: int) -> RobotId:
    return RobotId(Team.BLUE, number)


def yellow(number: int) -> RobotId:
    return RobotId(Team.YELLOW, number)


def goal_for_us() -> Predicate:
    """Blue scores between two frames that this one predicate is asked about in turn."""
    return _goal_for(Team.BLUE)


def goal_for_them() -> Predicate:
    return _goal_for(Team.YELLOW)


def _goal_for(team: Team) -> Predicate:
    seen: list[BallState] = []

    def scores(frame: Frame) -> bool:
        seen.append(frame.ball)
        return scorer(frame.field, seen[-2:][0], seen[-1]) is team

    return scores


def inside_the_field(frame: Frame) -> bool:
    """Every robot's centre is within the lines, with the margin's worth of tolerance."""
    return all(
        frame.field.contains(robot.x, robot.y, frame.field.margin - 0.09)
        for robot in (*frame.own, *frame.opponents)
    )


class Trial:
    """Trees on robots in the simulator.

    Args:
        trees: each moving robot's tree; robots only in ``poses`` stand still.
        poses: (x, y, heading) in world coordinates.
        ball: (x, y) or (x, y, vx, vy).
        settings: simulator settings or a preset's name.
    """

    def __init__(
        self,
        trees: Mapping[RobotId, Behaviour],
        poses: Mapping[RobotId, Pose],
        ball: tuple[float, ...] = (0.0, 0.0),
        settings: SimSettings | str = "default",
        period: float = 1 / 60,
        field: FieldGeometry = DIVISION_B,
        limits: RobotLimits | None = None,
        seed: int = 0,
    ) -> None:
        if isinstance(settings, str):
            settings = preset(settings)
        self.world = SimWorld(field, dict.fromkeys(poses, limits), settings, period)
        still = (0.0, 0.0) if len(ball) == 2 else ()
        self.world.reset(Placement(dict(poses), (*ball, *still)), seed)  # type: ignore[arg-type]
        frame = self.world.observe()
        teams = {team: TeamStore() for team in Team}
        views = {team: frame.seen_by(team) for team in Team}
        self.stores = {}
        self.runners = {}
        for robot, tree in trees.items():
            me = views[robot.team].robot(robot.number)
            assert me is not None
            self.stores[robot] = Store(views[robot.team], me, team=teams[robot.team])
            self.runners[robot] = TreeRunner(tree, self.stores[robot])
        self.frames: list[Frame] = [frame]
        self.kicks: list[tuple[float, RobotId]] = []

    def tick(self) -> Frame:
        """One control tick; returns the true frame after it."""
        frame = self.world.observe()
        views = {team: frame.seen_by(team) for team in Team}
        commands: dict[RobotId, RobotCommand] = {}
        for robot, runner in self.runners.items():
            store = self.stores[robot]
            store.frame = views[robot.team]
            me = store.frame.robot(robot.number)
            assert me is not None
            store.me = me
            store.command = RobotCommand()
            runner.tick()
            assert runner.error is None, runner.error
            commands[robot] = store.command
        self.world.act(commands)
        self.kicks += [(frame.time, robot) for robot in self.world.kicks]
        self.frames.append(self.world.truth())
        return self.frames[-1]

    def run(self, seconds: float, *statements: Statement) -> Frame:
        """Play until every *eventually* has held, at most ``seconds``; check every *always*."""
        waiting = [statement for statement in statements if statement.kind == "eventually"]
        watched = [statement for statement in statements if statement.kind == "always"]
        end = self.world.time + seconds
        while self.world.time < end - 1e-9:
            frame = self.tick()
            for statement in watched:
                assert statement.holds(frame), f"at {frame.time:.3f} s not always: {statement.what}"
            waiting = [statement for statement in waiting if not statement.holds(frame)]
            if not waiting and len(watched) < len(statements):
                return frame
        if waiting:
            missed = "; ".join(statement.what for statement in waiting)
            raise AssertionError(f"in {seconds} s not once: {missed}")
        return self.frames[-1]
