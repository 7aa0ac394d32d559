"""The interface every backend implements: the simulator, the league, a recorded match."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from robobt.world.command import RobotCommand
from robobt.world.detections import Detections
from robobt.world.game import Team
from robobt.world.sketch import Sketch
from robobt.world.state import Frame, RobotId

if TYPE_CHECKING:
    from robobt.world.delay import MeasuredDelay


@dataclass(slots=True)
class Placement:
    """Where everything stands at a start, in world coordinates (blue defends -x).

    Attributes:
        robots: (x, y, heading) of each robot [m, m, rad].
        ball: (x, y, vx, vy) [m, m, m/s, m/s].
        velocities: (vx, vy) of the robots that are not at rest [m/s]; only the simulator heeds this and what
            follows.
        turning: turning rates of robots [rad/s].
        commands: commands that robots follow until their first one reaches them.
        flight: height of the ball above the ground [m] and how fast it rises [m/s].
        slides: whether a moving ball slides, as after a kick.
        begin: time at the start [s].
    """

    robots: dict[RobotId, tuple[float, float, float]] = field(default_factory=dict)
    ball: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    velocities: dict[RobotId, tuple[float, float]] = field(default_factory=dict)
    turning: dict[RobotId, float] = field(default_factory=dict)
    commands: dict[RobotId, RobotCommand] = field(default_factory=dict)
    flight: tuple[float, float] = (0.0, 0.0)
    slides: bool = False
    begin: float = 0.0


class ReportedEvent(Protocol):
    """An event as referees report it: kind, time, team, robot and description."""

    @property
    def kind(self) -> str:
        """The league's name in lower case."""

    @property
    def time(self) -> float:
        """When [s]."""

    @property
    def team(self) -> Team | None:
        """Who did it."""

    @property
    def robot(self) -> RobotId | None:
        """Which robot, as far as known."""

    @property
    def text(self) -> str:
        """The details."""


@runtime_checkable
class World(Protocol):
    """A field that can be set up, looked at and acted upon.

    One control tick is one ``observe`` followed by one ``act``. Worlds inherit from
    this class, which has the optional members' defaults.
    """

    def reset(self, placement: Placement, seed: int) -> None:
        """Put robots and ball where ``placement`` says; ``seed`` fixes all later randomness.

        Raises:
            ValueError: a robot of the placement is not part of this world, or
                a coordinate is not finite or lies outside the walls.
        """

    def observe(self) -> Frame:
        """Return what the cameras and sensors report, seen from blue's side."""

    def truth(self) -> Frame:
        """Return the best knowledge of the real state, for referees and records, seen from blue's side."""

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Send one command per robot and advance one control period.

        ``commands`` are in each robot's own frame; a robot without one stands still.
        """

    def place_ball(self, x: float, y: float) -> None:
        """Put the ball down at rest (the referee's hand) at ``x``, ``y`` in world coordinates [m]."""

    def carry_robot(self, robot: RobotId, x: float, y: float) -> None:  # noqa: ARG002
        """Put a robot down at rest, as its handler does, at ``x``, ``y`` [m, world]; else people do it."""
        return

    def put_ball(self, x: float, y: float, vx: float, vy: float) -> None:  # noqa: ARG002
        """Place the ball with a velocity, if :attr:`movable`.

        It is put at ``x``, ``y`` in world coordinates [m] and rolls with ``vx``, ``vy`` [m/s].

        Raises:
            ValueError: it cannot be put there.
        """
        raise ValueError("nothing can be moved in this world")

    def put_robot(self, robot: RobotId, x: float, y: float, heading: float) -> None:  # noqa: ARG002
        """Place a robot at rest, if :attr:`movable`; a robot off the field returns.

        It is put at ``x``, ``y`` in world coordinates [m] and looks along ``heading`` [rad].

        Raises:
            ValueError: it cannot be put there.
        """
        raise ValueError("nothing can be moved in this world")

    def take_robot(self, robot: RobotId) -> None:  # noqa: ARG002
        """Take a robot off the field until it is placed again, if :attr:`movable`."""
        raise ValueError("nothing can be moved in this world")

    @property
    def movable(self) -> bool:
        """Whether robots and ball can be put elsewhere while a match is played."""
        return False

    @property
    def paced(self) -> bool:
        """Whether :meth:`act` itself waits for real time, as on a real field."""
        return False

    def seen_kicks(self) -> Sequence[tuple[RobotId, float]] | None:
        """Return the robots seen to kick between the last two frames, and the times [s].

        None where that follows from the true states and the commands.
        """
        return None

    def reported(self) -> Sequence[ReportedEvent]:
        """Return the events that the referee there has reported since this was asked last."""
        return ()

    def detections(self) -> Sequence[Detections]:
        """Return what cameras saw since this was asked last; empty where that is unknown, or the truth."""
        return ()

    @property
    def cameras(self) -> Mapping[int, tuple[float, float, float]]:
        """Where cameras that take every ball to lie on the ground are, by number: x, y and height [m].

        Empty where that is unknown, or where places on the ground are observed.
        """
        return {}

    def delays(self) -> Mapping[RobotId, MeasuredDelay | None]:
        """Return each commanded robot's whole delay, from a command to its seen effect.

        It is empty where none is measured. The delay of a robot that was not seen enough is None.
        """
        return {}

    def draw(self, sketch: Sketch) -> None:  # noqa: ARG002
        """Draw this world's further information on ``sketch``, in world coordinates, for viewers."""
        return

    @property
    def shows_truth(self) -> bool:
        """Whether :meth:`observe` always returns what :meth:`truth` does."""
        return False

    @property
    def cameras_show_truth(self) -> bool:
        """Whether cameras would show what :meth:`truth` returns, whatever :meth:`observe` makes of it."""
        return False

    @property
    def refereed(self) -> bool:
        """Whether a game controller decides the game that the frames hold."""
        return False

    @property
    def scenario_ends(self) -> bool:
        """Whether a scenario's ends hold; else a match lasts until the game controller ends it."""
        return True


class WrappedWorld(World):
    """A wrapper of another world, to which all members not overridden are passed on."""

    def __init__(self, world: World) -> None:
        self.world = world

    def reset(self, placement: Placement, seed: int) -> None:
        """See :meth:`World.reset`."""
        self.world.reset(placement, seed)

    def observe(self) -> Frame:
        """See :meth:`World.observe`."""
        return self.world.observe()

    def truth(self) -> Frame:
        """See :meth:`World.truth`."""
        return self.world.truth()

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """See :meth:`World.act`."""
        self.world.act(commands)

    def place_ball(self, x: float, y: float) -> None:
        """See :meth:`World.place_ball`."""
        self.world.place_ball(x, y)

    def carry_robot(self, robot: RobotId, x: float, y: float) -> None:
        """See :meth:`World.carry_robot`."""
        self.world.carry_robot(robot, x, y)

    def put_ball(self, x: float, y: float, vx: float, vy: float) -> None:
        """See :meth:`World.put_ball`."""
        self.world.put_ball(x, y, vx, vy)

    def put_robot(self, robot: RobotId, x: float, y: float, heading: float) -> None:
        """See :meth:`World.put_robot`."""
        self.world.put_robot(robot, x, y, heading)

    def take_robot(self, robot: RobotId) -> None:
        """See :meth:`World.take_robot`."""
        self.world.take_robot(robot)

    @property
    def movable(self) -> bool:
        """See :attr:`World.movable`."""
        return self.world.movable

    @property
    def paced(self) -> bool:
        """See :attr:`World.paced`."""
        return self.world.paced

    def seen_kicks(self) -> Sequence[tuple[RobotId, float]] | None:
        """See :meth:`World.seen_kicks`."""
        return self.world.seen_kicks()

    def reported(self) -> Sequence[ReportedEvent]:
        """See :meth:`World.reported`."""
        return self.world.reported()

    def detections(self) -> Sequence[Detections]:
        """See :meth:`World.detections`."""
        return self.world.detections()

    @property
    def cameras(self) -> Mapping[int, tuple[float, float, float]]:
        """See :attr:`World.cameras`."""
        return self.world.cameras

    def delays(self) -> Mapping[RobotId, MeasuredDelay | None]:
        """See :meth:`World.delays`."""
        return self.world.delays()

    def draw(self, sketch: Sketch) -> None:
        """See :meth:`World.draw`."""
        self.world.draw(sketch)

    @property
    def shows_truth(self) -> bool:
        """See :attr:`World.shows_truth`."""
        return self.world.shows_truth

    @property
    def cameras_show_truth(self) -> bool:
        """See :attr:`World.cameras_show_truth`."""
        return self.world.cameras_show_truth

    @property
    def refereed(self) -> bool:
        """See :attr:`World.refereed`."""
        return self.world.refereed

    @property
    def scenario_ends(self) -> bool:
        """See :attr:`World.scenario_ends`."""
        return self.world.scenario_ends
