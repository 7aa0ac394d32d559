"""The base of every skill and condition, and the list of them by name."""

from __future__ import annotations

from robobt.skills.store import Store
from robobt.tree import Leaf, Registry
from robobt.world.state import BallState, Frame, RobotState


class Skill(Leaf[Store]):
    """A leaf that sees ``frame`` from its own team's side and moves one robot, ``me``.

    A skill moves its robot by setting ``self.store.command``; one that sets
    nothing leaves it standing.
    """

    @property
    def frame(self) -> Frame:
        """What is on the field."""
        return self.store.frame

    @property
    def me(self) -> RobotState:
        """The robot this skill moves."""
        return self.store.me

    @property
    def ball(self) -> BallState:
        """The ball."""
        return self.store.frame.ball


SKILLS: Registry[type[Skill]] = Registry(
    "skill", group="robobt.skills", fits=lambda entry: isinstance(entry, type) and issubclass(entry, Skill)
)
"""Every skill and condition by its class name."""


def skill(cls: type[Skill]) -> type[Skill]:
    """Class decorator: enter a skill under its class name.

    Raises:
        ValueError: another skill has that name.
    """
    return SKILLS.register(cls.__name__)(cls)
