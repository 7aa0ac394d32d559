"""A scenario with nodes of its robots' trees replaced by scripts, to see what depends on them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from robobt.match.scenario.scenario import RobotSetup, Scenario
from robobt.skills.store import GIVEN, Store
from robobt.tree import check_tree
from robobt.world.game import Team
from robobt.world.state import RobotId


def substituted(scenario: Scenario, rules: Iterable[tuple[str, str, Any]]) -> Scenario:
    """The scenario with these rules before those it has.

    Args:
        scenario: it is not changed.
        rules: for each the robot ("blue 0", or a team's name for all of its robots), the pattern of
            the nodes' paths, and a status or a list of them, as in
            :func:`~robobt.tree.devtools.read_substitutions`.

    Raises:
        ScenarioError: there is no such robot or node, the status is none, or another node needs
            what a replaced one would have written.
    """
    more: dict[RobotId, dict[str, Any]] = {robot: {} for robot, _ in scenario.robots}
    for who, pattern, script in rules:
        meant = [robot for robot in more if who in (str(robot), robot.team.value)]
        if not meant:
            there = ", ".join(str(robot) for robot in more)
            raise scenario.error(
                f"there is no robot {who!r} to substitute nodes of; there are {there}", "robots"
            )
        for robot in meant:
            more[robot][pattern] = script
    robots = {
        team.value: tuple(
            _with(scenario, RobotId(team, setup.number), setup, more[RobotId(team, setup.number)])
            for setup in scenario.robots.of(team)
        )
        for team in Team
    }
    return scenario.model_copy(update={"robots": scenario.robots.model_copy(update=robots)})


def _with(scenario: Scenario, robot: RobotId, setup: RobotSetup, rules: dict[str, Any]) -> RobotSetup:
    if not rules:
        return setup
    if isinstance(setup.substitute, str):
        raise scenario.error(f"{robot} has its rules in {setup.substitute}; add yours there", "robots")
    others = {path: script for path, script in setup.substitute.items() if path not in rules}
    changed = setup.model_copy(update={"substitute": {**rules, **others}})
    try:
        check_tree(changed.build_tree(), Store, GIVEN)
    except ValueError as error:
        raise scenario.error(f"substitute for {robot}: {error}", "robots") from error
    return changed
