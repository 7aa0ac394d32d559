"""Condition: this robot plays a role."""

from __future__ import annotations

from typing import ClassVar

from robobt.skills.base import Skill, skill
from robobt.tree import Status


@skill
class HasRole(Skill):
    """SUCCESS while the role shared out to this robot by ``AssignRoles`` is this one.

    Args:
        role: name of the role.
    """

    reads: ClassVar[tuple[str, ...]] = ("team",)

    def __init__(self, *, role: str = "attacker", name: str = "") -> None:
        super().__init__(name)
        self.role = role

    def on_running(self) -> Status:
        """Look it up."""
        role = self.store.team.roles.get(self.me.id)
        return self.succeed() if role == self.role else self.fail(role or "no role")
