"""Share out the team's roles."""

from __future__ import annotations

from typing import ClassVar

from robobt.skills.base import Skill, skill
from robobt.skills.team.roles import ROLES, agree_roles
from robobt.tree import Status


@skill
class AssignRoles(Skill):
    """SUCCESS with a role for this robot, FAILURE when the others have all of them.

    The robots that ask share the roles so that all their ways together are
    shortest, and keep them until other ways are shorter by more than ``margin``.
    :class:`~robobt.skills.team.has_role.HasRole` asks for the result.

    Every robot of a team has to ask for the same roles with the same margin: the
    first one that is ticked on a frame decides for all.

    Args:
        roles: names in :data:`~robobt.skills.team.roles.ROLES`, in order of importance: with
            fewer robots than roles the last ones stay open.
        margin: how much a change has to gain [m].
    """

    reads: ClassVar[tuple[str, ...]] = ("team",)
    writes: ClassVar[tuple[str, ...]] = ("team",)

    def __init__(
        self,
        *,
        roles: tuple[str, ...] = ("attacker", "defender", "supporter"),
        margin: float = 0.5,
        name: str = "",
    ) -> None:
        super().__init__(name)
        for role in roles:
            if role not in ROLES:
                raise ValueError(f"no role is called {role!r}; there are {', '.join(ROLES)}")
        if len(set(roles)) < len(roles):
            raise ValueError(f"a role is named twice: {', '.join(roles)}")
        self.roles = roles
        self.margin = margin

    def on_running(self) -> Status:
        """Enter oneself and agree with the others."""
        team, number = self.store.team, self.me.id
        if number not in team.role_players:
            team.role_players.add(number)
            team.roles_agreed_on = None
        role = agree_roles(self.frame, team, self.roles, self.margin).get(number)
        return self.fail("no role left") if role is None else self.succeed(role)
