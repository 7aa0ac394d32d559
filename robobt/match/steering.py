"""A person's changes to a running match; each is recorded as an event."""

from __future__ import annotations

from collections.abc import Mapping
from math import degrees
from typing import Any

from py_trees.behaviour import Behaviour
from pydantic import ValidationError

from robobt.config.errors import RobobtError, message_of
from robobt.config.validation import first_problem
from robobt.match.loop import MatchLoop
from robobt.match.players import Driver, Player
from robobt.match.referee.by_hand import Order, give
from robobt.match.referee.referee import Referee
from robobt.match.scenario.robots import RobotSetup
from robobt.match.situation import situation_of
from robobt.plays.files import find_play
from robobt.tree.devtools.substitution import replaced
from robobt.tree.leaf import Leaf
from robobt.tree.namespace import within
from robobt.tree.parameters import Parameter, check_parameters, parameters_of
from robobt.tree.recording import node_ids
from robobt.tree.walk import preorder
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import RobotId


class SteeringError(RobobtError, ValueError):
    """A change is not possible in this match."""


class Steering:
    """Changes a match between two ticks; places are in world coordinates [m], headings in radians."""

    def __init__(self, match: MatchLoop) -> None:
        self._match = match
        self._setups = dict(match.scenario.robots)

    @property
    def movable(self) -> bool:
        """Whether robots and ball can be moved; they cannot on a real field."""
        return self._match.world.movable

    @property
    def orders(self) -> bool:
        """Whether the referee takes orders."""
        return isinstance(self._match.referee, Referee)

    def setup(self, robot: RobotId) -> RobotSetup:
        """Return the present set-up of a robot."""
        if robot not in self._setups:
            raise SteeringError(f"{robot} does not play here")
        return self._setups[robot]

    def move_ball(self, x: float, y: float, vx: float = 0.0, vy: float = 0.0, held: bool = False) -> None:
        """Place the ball with a velocity [m/s]; while it is being dragged this records no event."""
        self._check_movable()
        self._try(lambda: self._match.world.put_ball(x, y, vx, vy))
        if held:
            return
        rolling = f" with {vx:.2f}, {vy:.2f} m/s" if vx or vy else ""
        self._note("ball moved", text=f"to {x:.2f}, {y:.2f} m{rolling}")

    def move_robot(self, robot: RobotId, x: float, y: float, heading: float, held: bool = False) -> None:
        """Place a robot at rest, on the field again if it was off; dragging it records no event."""
        self._check_movable()
        self.setup(robot)
        heading = wrap_angle(heading)
        self._try(lambda: self._match.world.put_robot(robot, x, y, heading))
        if held:
            return
        self._note("robot moved", robot, f"to {x:.2f}, {y:.2f} m, {degrees(heading):.0f} degrees")

    def take_off(self, robot: RobotId) -> None:
        """Take a robot off the field."""
        self._check_movable()
        self.setup(robot)
        self._try(lambda: self._match.world.take_robot(robot))
        self._note("robot taken off", robot)

    def order(self, order: Order, team: Team | None) -> None:
        """Give an order as the referee."""
        referee = self._match.referee
        if not isinstance(referee, Referee):
            there = "a game controller" if self._match.world.refereed or referee is not None else "nobody"
            raise SteeringError(f"{there} referees this match, who takes no orders from here")
        controller = referee.controller
        if controller is None:
            raise SteeringError("the referee takes orders from the first tick on")
        self._try(lambda: give(controller, referee.field, order, team))
        self._note("referee's order", text=order, team=team)

    def play(self, robot: RobotId, play: str, params: Mapping[str, object]) -> None:
        """Give a robot another play, or its play other parameters."""
        self._rebuild(robot, {"play": play, "params": dict(params)}, {})
        given = ", ".join([f"{name}={value}" for name, value in params.items()])
        self._note("plays", robot, f"{play}({given})")

    def change_skill(self, robot: RobotId, path: str, params: Mapping[str, object]) -> None:
        """Give a skill in a robot's tree other parameters; ``path`` is the node's id in recordings."""
        self._rebuild(robot, {}, {path: params})
        given = ", ".join([f"{name}={value}" for name, value in params.items()])
        self._note("skill changed", robot, f"{path}: {given}")

    def parameters(self, robot: RobotId, path: str = "") -> list[tuple[Parameter, Any]]:
        """Return the parameters of a robot's play, or of a node, whose values are plain data."""
        setup = self.setup(robot)
        if path:
            node = _find(self.player(robot).runner.root, path)
            if not isinstance(node, Leaf):
                return []
            given = node.parameters()
            known = parameters_of(type(node))
        else:
            with within(setup.owner()):
                builder = find_play(setup.play)
                known = parameters_of(builder)
                given = check_parameters(setup.play, builder, setup.params)
        found = []
        for parameter in known:
            try:
                value = parameter.plain(given.get(parameter.name, parameter.default))
            except ValueError:
                continue
            if parameter.name != "name":
                found.append((parameter, value))
        return found

    def drive(self, robot: RobotId, driver: Driver | None) -> None:
        """Let a person drive a robot instead of its tree, or give it back to the tree."""
        player = self.player(robot)
        if driver is not None:
            player.runner.stop()
        self._match.set_driver(player, driver)
        self._note("driven by hand" if driver is not None else "driven by its tree", robot)

    def player(self, robot: RobotId) -> Player:
        """Return the player that moves a robot now."""
        for player in self._match.players:
            if player.robot == robot:
                return player
        raise SteeringError(f"{robot} does not play here")

    def situation(self) -> dict[str, Any]:
        """Return the scenario that starts from the present situation, as data.

        Raises:
            SteeringError: no robot is on the field, and a scenario has at least one.
        """
        frame = self._match.world.truth()
        if not frame.robots():
            raise SteeringError("no robot is on the field: there is no situation to begin from")
        return situation_of(self._match.scenario, frame, self._setups)

    def _rebuild(
        self, robot: RobotId, changes: Mapping[str, object], nodes: Mapping[str, Mapping[str, object]]
    ) -> None:
        player, setup = self.player(robot), self.setup(robot)
        try:
            if changes:
                setup = setup.changed(changes)
            tree = setup.build_tree()
            for path, params in nodes.items():
                tree = _with_changed(tree, path, params)
        except ValidationError as error:
            field, problem = first_problem(error, RobotSetup)
            raise SteeringError(f"{field}: {problem}") from error
        except Exception as error:
            # Plays and skills are users' code; the match continues whatever they raise.
            raise SteeringError(message_of(error)) from error
        self._setups[robot] = setup
        player.names = setup.owner()
        self._match.change_tree(player, tree, setup.play)

    def _check_movable(self) -> None:
        if not self.movable:
            raise SteeringError("nothing can be moved here: this is no simulator of ours")

    def _try(self, what: Any) -> None:
        try:
            what()
        except ValueError as error:
            raise SteeringError(message_of(error)) from error

    def _note(
        self, kind: str, robot: RobotId | None = None, text: str = "", team: Team | None = None
    ) -> None:
        time = self._match.world.truth().time
        self._match.capture().event(kind, time, robot=robot, team=team, text=text)


def _find(root: Behaviour, path: str) -> Behaviour:
    nodes = preorder(root)
    for node, (_, known) in zip(nodes, node_ids(nodes), strict=True):
        if known == path:
            return node
    raise SteeringError(f"no node of the tree is called {path!r}")


def _with_changed(root: Behaviour, path: str, params: Mapping[str, object]) -> Behaviour:
    """Return the tree with a leaf rebuilt with other values of these parameters."""
    leaf = _find(root, path)
    if not isinstance(leaf, Leaf):
        raise SteeringError(f"{path} is no skill")
    kind = type(leaf)
    changed = check_parameters(kind.__name__, kind, {**_plain_given(leaf), **params})
    return replaced(root, leaf, kind(**{**leaf.parameters(), **changed}))


def _plain_given(leaf: Leaf[Any]) -> dict[str, object]:
    """Return a leaf's parameters as plain data, so that only changed ones are checked again."""
    required = {parameter.name: parameter for parameter in parameters_of(type(leaf)) if parameter.required}
    return {name: parameter.plain(leaf.parameters()[name]) for name, parameter in required.items()}
