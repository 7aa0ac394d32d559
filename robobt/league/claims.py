"""Claims of robots within this process and on this machine: a robot obeys the last sender."""

from __future__ import annotations

import socket
import sys
from collections.abc import Callable, Collection

from robobt.world.game import Team
from robobt.world.state import RobotId


class RobotClaims:
    """The robots that one world of this process commands.

    An earlier claim of the same robots in this process is released first. Other processes of this machine are
    found by the names of network sockets, which the kernel frees with a process; programs other than robobt
    make no claims.

    ``where`` is the common name of the field; ``robots`` is None for all robots of the ``teams``. ``release``
    gives them up; ``taken`` are robots that another process commands.
    """

    def __init__(
        self,
        where: str,
        robots: Collection[RobotId] | None,
        teams: Collection[Team],
        release: Callable[[], None],
    ) -> None:
        self._where, self._teams = where, set(teams)
        self._robots = None if robots is None else {robot for robot in robots if robot.team in self._teams}
        self._release = release
        self._names: list[socket.socket] = []
        self.taken: list[RobotId] = []
        for other in list(_held):
            if self._shares(other):
                other._release()
        _held.add(self)
        for robot in sorted(self._robots or ()):
            self._name(robot)

    def message(self) -> str:
        """Return the warning about taken robots."""
        listed = ", ".join(map(str, self.taken))
        return (
            f"another process commands the same robots there: {listed}; they obey whoever sent last. End one "
            "of the two, or let each command a team of its own ('teams=blue' in the address)"
        )

    def close(self) -> None:
        """Release these robots for others."""
        _held.discard(self)
        for name in self._names:
            name.close()
        self._names.clear()

    def _shares(self, other: RobotClaims) -> bool:
        if self._where != other._where:
            return False
        if self._robots is None or other._robots is None:
            return not self._teams.isdisjoint(other._teams)
        return not self._robots.isdisjoint(other._robots)

    def _name(self, robot: RobotId) -> None:
        if sys.platform != "linux":
            # Only on Linux does a socket's name need no file, which might be left behind.
            return
        name = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            name.bind(f"\0robobt {self._where} {robot}")
        except OSError:
            name.close()
            self.taken.append(robot)
        else:
            self._names.append(name)


_held: set[RobotClaims] = set()
"""The claims of this process."""
