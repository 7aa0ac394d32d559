"""Who plays which role: the cheapest assignment that does not change for little."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from math import isnan
from typing import TypeVar

import numpy as np

Player = TypeVar("Player", bound=Hashable)
Role = TypeVar("Role", bound=Hashable)


def assign_roles(
    costs: Mapping[Player, Mapping[Role, float]], current: Mapping[Player, Role], margin: float
) -> dict[Player, Role]:
    """One role at most for each player, one player at most for each role.

    Of all assignments that fill as many roles as possible, the one of the least
    total cost (the Hungarian assignment). The current one is kept as long as it
    fills as many roles and its total exceeds the least by no more than ``margin``:
    a total rather than each player's cost, so that no series of small gains turns
    the team round. Ties fall by the order of players and roles.

    Args:
        costs: what each role costs each player, in any unit; a role that is missing
            or infinite cannot be played.
        current: the assignment so far; players and roles that are gone do not matter.
        margin: how much a change has to gain, in the unit of the costs; 0 or more.

    Raises:
        ValueError: a cost is NaN or minus infinity, or the margin is negative.
    """
    # Half a second of import that only teams with roles shall pay for.
    from scipy.optimize import linear_sum_assignment

    if not margin >= 0.0:
        raise ValueError(f"margin must be 0 or more, not {margin}")
    players = list(costs)
    roles = list(dict.fromkeys(role for row in costs.values() for role in row))
    known: dict[tuple[Player, Role], float] = {}
    for player, row in costs.items():
        for role, cost in row.items():
            if isnan(cost) or cost == float("-inf"):
                raise ValueError(f"the cost of {role} for {player} is {cost}")
            if cost != float("inf"):
                known[player, role] = cost
    if not known:
        return {}
    # Dearer than any difference of totals, so that it is only paid where no role can be filled instead.
    barred = 1.0 + 2.0 * sum(map(abs, known.values()))
    matrix = np.array([[known.get((player, role), barred) for role in roles] for player in players])
    rows, columns = linear_sum_assignment(matrix)
    pairs = [(players[row], roles[column]) for row, column in zip(rows, columns, strict=True)]
    best = dict(pair for pair in pairs if pair in known)
    kept = {player: role for player, role in current.items() if (player, role) in known}
    if len(set(kept.values())) == len(kept) == len(best):
        gain = sum(known[pair] for pair in kept.items()) - sum(known[pair] for pair in best.items())
        if gain <= margin:
            return kept
    return best
