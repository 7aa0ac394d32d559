"""Viewers' changes to a match: moving objects, changing plays and skills, giving referee orders."""

from __future__ import annotations

import typing
from collections.abc import Callable, Mapping
from typing import Any

from robobt.config.errors import RobobtError
from robobt.config.yaml import write_yaml
from robobt.live.driving import HandDriver
from robobt.live.messages import (
    Act,
    AskForm,
    ChangeSkill,
    Drive,
    GiveOrder,
    MoveBall,
    MoveRobot,
    Play,
    Release,
    Rest,
    Situation,
    Take,
    TakeOff,
    robot_of,
)
from robobt.live.server import Server
from robobt.match.loop import MatchLoop
from robobt.match.steering import Steering, SteeringError
from robobt.models.find import paths_in
from robobt.plays import PLAYS
from robobt.tree.parameters import Parameter
from robobt.world.state import RobotId

_LASTS = 0.5
"""Silence of the page after which a held object is released [s]."""


class HeldObjects:
    """The held robots and ball; times are by one clock [s]."""

    def __init__(self) -> None:
        self._held: dict[str, tuple[MoveBall | MoveRobot, float]] = {}

    def follow(self, move: MoveBall | MoveRobot, now: float) -> None:
        """Hold or release the moved object, as the move says."""
        name = move.robot if isinstance(move, MoveRobot) else "ball"
        if move.held:
            self._held[name] = move, now
        else:
            self.let_go(name)

    def let_go(self, name: str) -> None:
        """Release this robot, or "ball"."""
        self._held.pop(name, None)

    @property
    def holding(self) -> bool:
        """Whether anything is held."""
        return bool(self._held)

    def moves(self, now: float) -> list[MoveBall | MoveRobot]:
        """Return the moves that keep all held objects in place."""
        if not self._held:
            return []
        self._held = {name: held for name, held in self._held.items() if now <= held[1] + _LASTS}
        return [move for move, _ in self._held.values()]


class Hands:
    """Carries out messages on one match, and reports to the viewers what is not possible."""

    def __init__(self, match: MatchLoop, server: Server, clock: Callable[[], float]) -> None:
        self._match, self._server, self._clock = match, server, clock
        self._steering = Steering(match)
        self._grip = HeldObjects()
        self._situations = 0
        # A page may have no other files of this machine loaded, as a play or as a model.
        self._files = paths_in(match.scenario.model_dump(mode="json"))
        self._plays = [*dict.fromkeys([*PLAYS, *[setup.play for _, setup in match.scenario.robots]])]
        server.tell(
            movable=self._steering.movable,
            orders=self._steering.orders,
            game_controller=match.world.refereed or (match.referee is not None and not self._steering.orders),
            plays=self._plays,
            form=None,
            said=None,
            situation=0,
            driven=None,
            span=None,
        )
        self._driver: HandDriver | None = None
        self._driven: RobotId | None = None

    def do(self, act: Act, now: float, arrived: float) -> None:
        """Carry out a message, or report why not; ``arrived`` is its time of arrival."""
        try:
            if isinstance(act, Drive | Rest | Take | Release):
                self._drive(act, arrived)
            else:
                self._do(act, now)
        except RobobtError as error:
            self._server.say(str(error))

    def hold(self, now: float) -> None:
        """Keep held objects in place, before the next tick."""
        for move in self._grip.moves(now):
            try:
                self._move(move)
            except SteeringError as error:
                self._grip.follow(move.model_copy(update={"held": False}), now)
                self._server.say(str(error))

    @property
    def holding(self) -> bool:
        """Whether anything is held where it is."""
        return self._grip.holding

    def _do(self, act: Act, now: float) -> None:
        steering = self._steering
        match act:
            case MoveBall() | MoveRobot():
                self._move(act)
                self._grip.follow(act, now)
            case TakeOff(robot=robot):
                self._grip.let_go(robot)
                steering.take_off(robot_of(robot))
            case GiveOrder(order=order, team=team):
                steering.order(order, team)
            case AskForm(robot=robot, path=path):
                self._tell_form(robot_of(robot), path)
            case Play(play=play) if play not in self._plays:
                raise SteeringError(f"no play of this match is called {play!r}")
            case Play(robot=robot, play=play, params=params):
                self._check_files(robot_of(robot), "", params)
                for each in self._meant(act):
                    steering.play(each, play, params)
                self._tell_form(robot_of(robot), "")
            case ChangeSkill(robot=robot, path=path, params=params):
                self._check_files(robot_of(robot), path, params)
                steering.change_skill(robot_of(robot), path, params)
                self._tell_form(robot_of(robot), path)
            case Situation():
                self._server.situation = write_yaml(steering.situation())
                self._situations += 1
                self._server.tell(situation=self._situations)

    def take(self, robot: RobotId) -> None:
        """Let the steering viewer drive a robot."""
        self.release()
        self._driver = HandDriver(self._clock, self._match.scenario.period)
        self._steering.drive(robot, self._driver)
        self._driven = robot
        self._server.tell(driven=str(robot))

    def release(self) -> None:
        """Give the driven robot back to its tree."""
        if self._driven is not None:
            self._steering.drive(self._driven, None)
        self._driven = self._driver = None
        self._server.tell(driven=None)

    @property
    def driving(self) -> bool:
        """Whether the page of whoever drives has sent a command."""
        return self._driver is not None and self._driver.told

    def _drive(self, act: Drive | Rest | Take | Release, arrived: float) -> None:
        if isinstance(act, Take):
            self.take(robot_of(act.robot))
        elif isinstance(act, Release):
            self.release()
        elif self._driver is None:
            pass
        elif isinstance(act, Rest):
            self._driver.stop()
        else:
            velocity = (act.vx, act.vy)
            ordered = (act.omega, act.frame, act.dribbler, act.kick, act.assist)
            self._driver.command(act.at, arrived, velocity, *ordered)

    def _move(self, move: MoveBall | MoveRobot) -> None:
        if isinstance(move, MoveBall):
            self._steering.move_ball(move.x, move.y, move.vx, move.vy, move.held)
        else:
            self._steering.move_robot(robot_of(move.robot), move.x, move.y, move.heading, move.held)

    def _check_files(self, robot: RobotId, path: str, params: Mapping[str, object]) -> None:
        """Refuse parameters that name a file unless the scenario or the present parameters name it too."""
        for file in paths_in(dict(params)) - self._files:
            if file not in paths_in([value for _, value in self._steering.parameters(robot, path)]):
                raise SteeringError(
                    f"{file!r} is a file: a page names models that are installed, by their names"
                )

    def _meant(self, act: Play) -> list[RobotId]:
        robot = robot_of(act.robot)
        if not act.team:
            return [robot]
        keeper = self._match.scenario.goalkeepers().get(robot.team)
        players = [player.robot for player in self._match.players]
        return [it for it in players if it.team is robot.team and it.number != keeper]

    def _tell_form(self, robot: RobotId, path: str) -> None:
        fields = [_field(parameter, value) for parameter, value in self._steering.parameters(robot, path)]
        setup = self._steering.setup(robot)
        self._server.show_form(robot=str(robot), path=path, play=setup.play, fields=fields)


def _field(parameter: Parameter, value: Any) -> dict[str, Any]:
    """Describe a parameter for a form: how it is entered, and what it is now."""
    hint = parameter.hint
    if typing.get_origin(hint) is typing.Annotated:
        hint = typing.get_args(hint)[0]
    kinds: dict[object, str] = {bool: "switch", int: "integer", float: "number", str: "text"}
    entered = kinds.get(hint, "data")
    choices: list[Any] = []
    if typing.get_origin(hint) is typing.Literal:
        entered, choices = "choice", list(typing.get_args(hint))
    return {
        "name": parameter.name,
        "type": parameter.kind,
        "entered": entered,
        "choices": choices,
        "value": value,
    }
