"""The base of every skill and condition, and the list of them by name."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import atan2, hypot, radians
from typing import TypeVar, dataclass_transform

from robobt.motion.path_planner import travel
from robobt.motion.pilot import roughly
from robobt.motion.scene import BALL_GAP
from robobt.skills.store import Store
from robobt.tree import Leaf, Registry
from robobt.world.compiled import compilable
from robobt.world.geometry import Point, direction
from robobt.world.limits import RobotLimits
from robobt.world.records import Robot
from robobt.world.sketch import Sketch
from robobt.world.state import ROBOT_RADIUS, BallState, Frame, RobotState

FACING = radians(15.0)
"""Largest heading error of a robot that only has to face a point roughly."""


KICKER_GAP = 0.1
"""Distance that the kicker of a restart keeps from the ball until another robot has touched it [m]."""


@dataclass(eq=False, repr=False)
class Skill(Leaf[Store]):
    """A leaf that sees ``frame`` from its own team's side and moves one robot, ``me``.

    A skill moves its robot by setting ``self.store.command``; one that sets
    nothing leaves it standing. Its parameters are the fields of its class.
    """

    name: str = ""

    def __post_init__(self) -> None:
        """Make the node. A subclass calls this first, then checks its parameters and sets up its state."""
        super().__init__(self.name)

    @property
    def frame(self) -> Frame:
        """The current frame, from the own team's side."""
        return self.store.frame

    @property
    def me(self) -> RobotState:
        """The robot this skill moves."""
        return self.store.me

    @property
    def ball(self) -> BallState:
        """The ball."""
        return self.store.frame.ball

    @property
    def draw(self) -> Sketch:
        """Draws on the field for viewers, in named layers: ``self.draw.line("plan", a, b)``."""
        return self.store.draw

    @property
    def drive_limits(self) -> RobotLimits:
        """The driving limits that apply now."""
        return self.store.me.limits

    @property
    def has_kicked(self) -> bool:
        """Whether this robot took a restart and may not touch the ball before another has."""
        return self.store.team.kicker == self.me.id

    def drive_to(
        self,
        target: Point,
        facing: Point,
        *,
        avoid_robots: bool = True,
        avoid_ball: bool = False,
        goalkeeper: bool = False,
        thereabouts: bool = False,
        slack: float = FACING,
        spare_mates: bool = False,
    ) -> None:
        """Command the planned way to ``target``, the mouth to the point ``facing``; see :func:`travel`.

        The way leads round robots (``avoid_robots``) and the ball (``avoid_ball``), keeps more distance from
        team-mates with ``spare_mates``, and leads through the own defence area for a ``goalkeeper`` only.

        With ``thereabouts`` the robot faces the point only roughly, so that it does not turn after every
        movement of a ball: at most ``slack`` [rad] off it, or more if the point is so close that the robot's
        own width covers a larger angle.
        """
        store = self.store
        frame, me = store.frame, store.me
        here = me.position
        heading = heading_thereabouts(me, facing, slack) if thereabouts else direction(here, facing)
        has_kicked = self.has_kicked
        store.command = travel(
            frame,
            me,
            target,
            heading,
            self.drive_limits,
            avoid_robots=avoid_robots,
            avoid_ball=avoid_ball or has_kicked,
            ball_gap=KICKER_GAP if has_kicked else BALL_GAP,
            goalkeeper=goalkeeper,
            spare_mates=spare_mates,
            sketch=store.draw,
        )


@compilable
def heading_thereabouts(me: Robot, facing: Point, slack: float) -> float:
    """Return the heading of a robot that looks at most ``slack`` past the point ``facing`` [rad].

    The direction to a close point changes quickly, and the robot's own width covers a larger angle there.
    """
    dx, dy = facing[0] - me.x, facing[1] - me.y
    return roughly(me.heading, atan2(dy, dx), slack + atan2(ROBOT_RADIUS, hypot(dx, dy)))


class Condition(Skill):
    """A leaf that only checks something: it succeeds or fails at once and commands nothing."""

    condition = True


SKILLS: Registry[type[Skill]] = Registry(
    "skill", group="robobt.skills", fits=lambda entry: isinstance(entry, type) and issubclass(entry, Skill)
)
"""Every skill and condition by its class name."""


SkillT = TypeVar("SkillT", bound=Skill)


@dataclass_transform(kw_only_default=True, eq_default=False, field_specifiers=(field,))
def skill(cls: type[SkillT]) -> type[SkillT]:
    """Class decorator: register a skill under its class name, and return it.

    The fields of the class become parameters of its constructor, by keyword,
    unless it writes a constructor of its own.
    """
    if "__init__" not in vars(cls):
        dataclass(kw_only=True, eq=False, repr=False)(cls)
    SKILLS.register(cls.__name__)(cls)
    return cls
