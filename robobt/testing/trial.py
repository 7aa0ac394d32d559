"""Trees on robots in the simulator, and statements about what becomes of them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from py_trees.behaviour import Behaviour

from robobt.sim import SimSettings, SimWorld, preset
from robobt.skills.store import Store, TeamStore
from robobt.testing.predicates import HasStatus
from robobt.testing.statements import Statement
from robobt.tree import TreeRunner
from robobt.world import (
    DIVISION_B,
    FieldGeometry,
    Frame,
    Placement,
    RobotCommand,
    RobotId,
    RobotLimits,
    RobotState,
    Team,
)
from robobt.world.answer import compensated
from robobt.world.prediction import predicted

Pose = tuple[float, float, float]
"""Place and heading of a robot (x, y, heading) [m, rad]."""


def blue(number: int) -> RobotId:
    """Return the robot of team blue with this ``number``."""
    return RobotId(Team.BLUE, number)


def yellow(number: int) -> RobotId:
    """Return the robot of team yellow with this ``number``."""
    return RobotId(Team.YELLOW, number)


class Trial:
    """Trees on robots in the simulator; all places are as blue sees the field.

    As in a match, trees see frames that are predicted over delays, and commands are divided by the gains of
    the robots.

    ::

        go = GoToBall()
        trial = Trial({blue(1): go}, {blue(1): (-1.0, 0.0, 0.0)}, ball=(0.0, 0.0))
        trial.run(
            5.0,
            eventually("it is at the ball", succeeds(go)),
            always("all robots are inside the field", inside_the_field),
        )

    Args:
        trees: each moving robot's tree; robots only in ``poses`` stand still.
        poses: place and heading (x, y, heading) of each robot [m, rad].
        ball: its place (x, y) [m], or with its velocity (x, y, vx, vy) [m, m/s].
        settings: of the simulator, or a preset's name.
        period: of control [s].
        field: its dimensions.
        limits: how fast robots drive; the settings' by default.
        seed: of noise.

    Attributes:
        world: the simulator.
        stores: of the robots with a tree.
        frames: the true frames so far, as blue sees them, the start first.
        kicks: who kicked, and when [s].

    Raises:
        ValueError: a robot with a tree has no pose.
        TreeError: a tree is wrongly put together.
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
        realism = settings.realism
        self._seen = predicted(
            self.world, (limits or settings.limits,), realism.vision_delay, realism.command_delay
        )
        still = (0.0, 0.0) if len(ball) == 2 else ()
        self._seen.reset(Placement(dict(poses), (*ball, *still)), seed)
        frame = self._seen.observe()
        teams = {team: TeamStore() for team in Team}
        views = {team: frame.seen_by(team) for team in Team}
        self.stores: dict[RobotId, Store] = {}
        self._runners: dict[RobotId, TreeRunner] = {}
        for robot, tree in trees.items():
            view = views[robot.team]
            self.stores[robot] = Store(view, _robot(view, robot), team=teams[robot.team])
            self._runners[robot] = TreeRunner(tree, self.stores[robot], on_error="raise")
        self.frames: list[Frame] = [self.world.truth()]
        self.kicks: list[tuple[float, RobotId]] = []

    def tick(self) -> Frame:
        """Play one control period and return the true frame after it.

        Raises:
            TreeError: a node raised.
        """
        frame = self._seen.observe()
        views = {team: frame.seen_by(team) for team in Team}
        commands: dict[RobotId, RobotCommand] = {}
        for robot, runner in self._runners.items():
            store, view = self.stores[robot], views[robot.team]
            store.frame, store.me, store.command = view, _robot(view, robot), RobotCommand()
            runner.tick()
            commands[robot] = store.command
        self._seen.act(compensated(commands, frame))
        self.kicks += [(frame.time, robot) for robot in self.world.kicks]
        self.frames.append(self.world.truth())
        return self.frames[-1]

    def run(self, seconds: float, *statements: Statement) -> Frame:
        """Play until every *eventually* has held, and return the last frame.

        What has to hold *always* is asked of the frame from which this begins too; of a node's status only
        once the node has been ticked.

        Args:
            seconds: the longest that is played; without an *eventually* all of it is.
            statements: what has to hold.

        Raises:
            AssertionError: an *always* did not hold at a frame, or an *eventually* at none.
            TreeError: a node raised.
        """
        __tracebackhide__ = True
        waiting = [statement for statement in statements if statement.kind == "eventually"]
        watched = [statement for statement in statements if statement.kind == "always"]
        unticked = len(self.frames) == 1
        _check([it for it in watched if not (unticked and isinstance(it.holds, HasStatus))], self.frames[-1])
        end = self.world.time + seconds
        while self.world.time < end - 1e-9:
            frame = self.tick()
            _check(watched, frame)
            waiting = [statement for statement in waiting if not statement.holds(frame)]
            if not waiting and len(watched) < len(statements):
                return frame
        if waiting:
            missed = "; ".join(statement.what for statement in waiting)
            raise AssertionError(f"in {seconds} s not once: {missed}")
        return self.frames[-1]


def _check(watched: Sequence[Statement], frame: Frame) -> None:
    """Raise if one of the statements does not hold at a frame."""
    __tracebackhide__ = True
    for statement in watched:
        if not statement.holds(frame):
            raise AssertionError(f"at {frame.time:.3f} s not always: {statement.what}")


def alone(
    tree: Behaviour,
    pose: Pose,
    ball: tuple[float, ...] = (0.0, 0.0),
    settings: SimSettings | str = "default",
    period: float = 1 / 60,
) -> Trial:
    """Return the trial of one robot, ``blue(0)``, that is alone on the field.

    Args:
        tree: the robot's.
        pose: where it starts, and its heading (x, y, heading) [m, rad].
        ball: its place (x, y) [m], or with its velocity (x, y, vx, vy) [m, m/s].
        settings: of the simulator, or a preset's name.
        period: of control [s].
    """
    return Trial({blue(0): tree}, {blue(0): pose}, ball, settings, period)


def _robot(view: Frame, robot: RobotId) -> RobotState:
    found = view.robot(robot.number)
    if found is None:
        raise ValueError(f"{robot} is not on the field: give it a pose")
    return found
