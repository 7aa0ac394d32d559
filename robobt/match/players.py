"""The robots of a match, each with its tree and its store."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal, TypeAlias

from robobt.config.errors import one_line, short_repr, text_of
from robobt.config.process import users_code
from robobt.match.scenario.scenario import Scenario
from robobt.skills.store import Store, TeamStore
from robobt.tree import Behaviour, Status, TreeError, TreeRunner, node_path
from robobt.tree.engine import LEAVING
from robobt.tree.namespace import Namespace, within
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import Frame, RobotId, RobotState

_log = logging.getLogger(__name__)

Driver: TypeAlias = Callable[[Frame, RobotState], RobotCommand]
"""Decides for a robot in place of its tree, from its team's view."""


@dataclass(slots=True, repr=False)
class Player:
    """One robot on the field.

    Skills share ``store`` and look things up in ``names`` first. ``problem`` is the last failure of the tree:
    the node's path and what happened. If a person drives the robot, ``driver`` decides instead of the tree,
    which rests. ``failing`` is the node and the one reason for which the tree failed at every tick so far; it
    is None once the tree did anything else, or failed for another reason.
    """

    robot: RobotId
    runner: TreeRunner
    store: Store
    problem: str = ""
    names: Namespace | None = None
    driver: Driver | None = None
    failing: str | None = ""

    def __repr__(self) -> str:
        doing = f", problem={self.problem!r}" if self.problem else ""
        return f"<Player {self.robot}: {self.runner.root.name!r}{doing}>"

    def decide(self, view: Frame, me: RobotState) -> RobotCommand | None:
        """Tick the tree once and return its command, or None where the tree failed.

        Raises:
            TreeError: the tree failed, and ``on_error`` is "raise"; robot and node are named.
        """
        if self.driver is not None:
            return self.driver(view, me)
        store, runner = self.store, self.runner
        store.frame, store.me, store.command = view, me, RobotCommand()
        try:
            if self.names is None:
                runner.tick()
            else:
                with within(self.names):
                    runner.tick()
        except TreeError as error:
            raise TreeError(f"{self.robot}: {error}") from error.__cause__
        if self.failing is not None:
            self._follow_failure()
        if runner.error is not None:
            self.problem = runner.error
            return None
        command = getattr(store, "command", None)
        fault = _fault_of(command)
        if fault is None:
            return command
        self.problem = f"{node_path(runner.tip())}: {fault}"
        _log.warning("tree stopped: %s", self.problem)
        runner.stop()
        if runner.on_error == "raise":
            raise TreeError(f"{self.robot}: {self.problem}")
        return None

    def _follow_failure(self) -> None:
        tip = self.runner.tip() if self.runner.root.status is Status.FAILURE else None
        said = None if tip is None else f"{node_path(tip)}: {tip.feedback_message or 'fails'}"
        self.failing = said if self.failing in ("", said) else None


def make_players(scenario: Scenario, start: Frame) -> list[Player]:
    """Build every robot's tree and store, and set the trees up, in the order of teams and scenario."""
    teams = {team: TeamStore() for team in Team}
    players: list[Player] = []
    try:
        for robot, setup in scenario.robots:
            store = Store(start, RobotState(robot.number, 0.0, 0.0), team=teams[robot.team])
            tree, names = setup.build_tree(), setup.owner()
            runner = run_tree(robot, tree, store, scenario.on_error, names)
            players.append(Player(robot, runner, store, names=names))
    except BaseException:
        shut_down(players)
        raise
    return players


def run_tree(
    robot: RobotId, tree: Behaviour, store: Store, on_error: Literal["stop", "raise"], names: Namespace | None
) -> TreeRunner:
    """Set up a robot's tree, which looks things up in ``names`` first, and return its runner."""
    with within(names), users_code(str(robot)):
        return TreeRunner(tree, store, on_error)


def shut_down(players: Iterable[Player]) -> None:
    """Shut down the trees of all players."""
    for player in players:
        with within(player.names), users_code(str(player.robot)):
            player.runner.shutdown()


def _fault_of(command: object) -> str | None:
    """Return why a tree's command cannot be sent to its robot, or None if it can."""
    try:
        if not isinstance(command, RobotCommand):
            return f"command is no RobotCommand: {short_repr(command)}"
        return None if command.finite() else f"command is not finite: {text_of(command)}"
    except (TypeError, ValueError, OverflowError):
        return one_line(f"command is not made of numbers: {text_of(command)}")
    except LEAVING:
        raise
    except BaseException as error:
        # A class of the skill's own.
        return f"command cannot be read: {type(error).__name__}: {one_line(text_of(error))}"
