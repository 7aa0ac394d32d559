"""Replace nodes of the robots' trees by scripts, to see what depends on them."""

from __future__ import annotations

from collections.abc import Iterable

from robobt.config.errors import unknown_name
from robobt.match.scenario.scenario import Scenario


def substituted(scenario: Scenario, rules: Iterable[tuple[str, str, object]]) -> Scenario:
    """Return the scenario with additional substitution rules, ahead of its own.

    Args:
        scenario: the scenario, which stays unchanged.
        rules: each has the robot ("blue 0", or a team's name for all its robots), the pattern of the nodes'
            paths, and a status or a list of statuses, as in :func:`~robobt.tree.devtools.read_substitutions`.

    Raises:
        ScenarioError: there is no such robot, node or status, or another node needs an entry that a replaced
        node would have written.
    """
    added: dict[str, dict[str, object]] = {str(robot): {} for robot, _ in scenario.robots}
    for who, pattern, script in rules:
        names = [name for name in added if who in (name, name.partition(" ")[0])]
        if not names:
            raise scenario.error(
                f"there is no robot {who!r} to substitute nodes of; {unknown_name(who, added)}", "robots"
            )
        for name in names:
            added[name][pattern] = script
    changed = scenario
    for robot, setup in scenario.robots:
        if own := added[str(robot)]:
            if isinstance(setup.substitute, str):
                raise scenario.error(
                    f"{robot} has its rules in {setup.substitute}; add yours there", "robots"
                )
            others = {path: script for path, script in setup.substitute.items() if path not in own}
            changed = changed.with_robot(robot, substitute={**own, **others})
    return changed
