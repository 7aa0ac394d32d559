"""Counts of ticks and statuses of a play's nodes in a match."""

from __future__ import annotations

from pathlib import Path

from robobt.match.loop import MatchLoop, WorldFactory
from robobt.match.runner import trial_seed
from robobt.match.scenario.scenario import Scenario
from robobt.plays.files import rename_play
from robobt.tree.devtools import NodeStatistics
from robobt.world.state import RobotId


def node_statistics(
    scenario: Scenario, world_factory: WorldFactory, play: str | None = None, seed: int | None = None
) -> dict[RobotId, NodeStatistics]:
    """Play a scenario's first trial and count the ticks and statuses of its robots' nodes.

    Args:
        scenario: the scenario to play.
        world_factory: makes the world.
        play: count only robots with this play, whose file may be given by another path; None for all robots.
        seed: seed of the run; the scenario's by default.

    Raises:
        ScenarioError: no robot plays it, or the scenario does not fit the world.
    """
    match = MatchLoop(scenario, trial_seed(scenario.seed if seed is None else seed, 0), world_factory)
    counted = [player.robot for player in match.players] if play is None else robots_with(scenario, play)
    if not counted:
        there = ", ".join(dict.fromkeys([setup.play for _, setup in scenario.robots]))
        raise scenario.error(f"no robot plays {play!r}; they play {there}", "robots")
    watched = {}
    for player in match.players:
        if player.robot in counted:
            watched[player.robot] = NodeStatistics(player.runner.root)
            player.runner.show_to(watched[player.robot])
    match.play()
    return watched


def robots_with(scenario: Scenario, play: str) -> list[RobotId]:
    """Return the robots of a scenario that have a play, whose file may be given by another path."""
    return [robot for robot, setup in scenario.robots if _same_play(play, setup.play)]


def _same_play(one: str, other: str) -> bool:
    def whole(file: str) -> str:
        return str(Path(file).resolve())

    return rename_play(one, whole) == rename_play(other, whole)
