"""The robots of a scenario: play, limits and start of each."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import Self

from pydantic import (
    BaseModel,
    Field,
    PrivateAttr,
    ValidationError,
    ValidationInfo,
    field_validator,
    model_validator,
)

from robobt.config.errors import FieldError, RobobtError, message_of
from robobt.config.validation import first_problem
from robobt.match.scenario.starts import RobotStart, ScenarioPart
from robobt.plays.files import build_play, find_play, problem_with_play
from robobt.plays.mistakes import mistake_in_play
from robobt.plays.private_files import private_files
from robobt.skills.store import GIVEN, Store
from robobt.tree import Behaviour, WiringError, check_tree
from robobt.tree.devtools import substitute
from robobt.tree.interop import TreeFileError
from robobt.tree.namespace import Namespace
from robobt.tree.parameters import ParameterError, parameters_of
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

UNBUILT: Mapping[str, object] = {}
"""Context of a validation that builds no trees and so loads no models."""


class _Unplayed:
    """The tree built by validation, until it is played; it is not part of a set-up and not sent with it."""

    def __init__(self) -> None:
        self.tree: Behaviour | None = None

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Unplayed)

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[type[Self], tuple[()]]:
        return (type(self), ())


class RobotSetup(ScenarioPart):
    """One robot: its number, what it plays and where it starts."""

    number: int = Field(ge=0, le=15, description="number on its team")
    play: str = Field(
        max_length=4000,
        description="its play: a name, a tree file beside the scenario, or one of a Python file there, as "
        "my_team.py:striker",
    )
    params: dict[str, object] = Field(default_factory=dict, description="parameters of the play")
    goalkeeper: bool = Field(False, description="whether it is its team's goalkeeper")
    limits: RobotLimits | None = Field(
        None, description="limits of this robot; those not given are the simulator's"
    )
    substitute: dict[str, object] | str = Field(
        default_factory=dict,
        description="nodes of its tree to replace by scripts, by patterns of their paths; or a file of such "
        "rules beside the scenario",
    )
    start: RobotStart = Field(description="pose at the start, in the own team's view")
    _unplayed: _Unplayed = PrivateAttr(default_factory=lambda: _Unplayed())

    @field_validator("play")
    @classmethod
    def _known(cls, play: str) -> str:
        if problem := problem_with_play(play):
            raise ValueError(problem)
        return play

    @model_validator(mode="after")
    def _playable(self, info: ValidationInfo) -> Self:
        if info.context is UNBUILT:
            return self
        try:
            tree = self._build()
            check_tree(tree, Store, GIVEN)
        except ParameterError as error:
            raise FieldError(f"params.{error.parameter}", str(error)) from error
        except _SubstitutionError as error:
            raise FieldError("substitute", message_of(error)) from error
        except (TreeFileError, WiringError) as error:
            raise FieldError("play", message_of(error)) from error
        except ValidationError as error:
            # Settings of an object that the play builds from its parameters, such as a rater.
            field, problem = first_problem(error, BaseModel)
            if field.partition(".")[0] not in self.params:
                raise FieldError(self._blamed(error), f"{field}: {problem}") from error
            raise FieldError(f"params.{field}", problem) from error
        except Exception as error:
            field = self._blamed(error)
            said = mistake_in_play(error) if field in ("play", "params") else message_of(error)
            raise FieldError(field, said) from error
        self._unplayed.tree = tree
        return self

    def __copy__(self) -> Self:
        """Return a copy without a tree, because it may be changed."""
        copied = super().__copy__()
        copied._unplayed = _Unplayed()
        return copied

    def _blamed(self, error: Exception) -> str:
        """Return the field of the parameter that makes building the tree fail, if exactly one does."""
        if not self.params:
            return "play"
        blamed = []
        for name in self.params:
            others = {other: value for other, value in self.params.items() if other != name}
            with suppress(Exception):
                self.model_copy(update={"params": others})._build()
                blamed.append(name)
        if not blamed:
            # Several are wrong, or the play needs the parameter: the message names the file or play.
            said = str(error)
            blamed = [name for name, value in self.params.items() if isinstance(value, str) and value in said]
        return f"params.{blamed[0]}" if len(blamed) == 1 else "params"

    def build_tree(self) -> Behaviour:
        """Return a new tree of this robot's play.

        The first call returns the tree that validation built. Each further match needs its own tree, because
        nodes keep state; so does each process, because trees are not sent between processes.
        """
        tree, self._unplayed.tree = self._unplayed.tree, None
        return self._build() if tree is None else tree

    def _build(self) -> Behaviour:
        tree = build_play(self.play, self.params)
        if not self.substitute:
            return tree
        try:
            return substitute(tree, self.substitute)
        except TreeFileError as error:
            # Rules within the scenario have no file.
            problem = str(error) if isinstance(self.substitute, str) else error.problem
            raise _SubstitutionError(problem) from error

    def owner(self) -> Namespace | None:
        """Return the names that its tree finds first: those of its play's Python files, if any."""
        return private_files(self.play)

    def changed(self, changes: Mapping[str, object]) -> RobotSetup:
        """Return the setup with ``changes`` of its fields, or of its play's parameters, by name.

        A new play keeps the parameters that it also has.
        """
        data = {name: getattr(self, name) for name in self.model_fields_set}
        data |= {name: value for name, value in changes.items() if name in RobotSetup.model_fields}
        params = {name: value for name, value in changes.items() if name not in RobotSetup.model_fields}
        if "params" not in changes:
            data["params"] = self._params_in(data["play"])
        if params:
            data["params"] = {**data["params"], **params}
        return RobotSetup.model_validate(data)

    def default_of(self, parameter: str) -> object:
        """Return the default of a parameter of the play, or None."""
        known = {each.name: each.default for each in parameters_of(find_play(self.play)) if not each.required}
        return known.get(parameter)

    def _params_in(self, play: object) -> dict[str, object]:
        """Return the parameters that another play also has, or all if that play cannot be read."""
        if play == self.play or not isinstance(play, str) or problem_with_play(play):
            return self.params
        try:
            known = {parameter.name for parameter in parameters_of(find_play(play))}
        except (ParameterError, TreeFileError):
            return self.params
        return {name: value for name, value in self.params.items() if name.partition(".")[0] in known}

    def limits_over(self, base: RobotLimits) -> RobotLimits:
        """Return the robot's limits, from ``base`` where the scenario gives none."""
        if self.limits is None:
            return base
        return base.model_copy(update=self.limits.model_dump(exclude_unset=True))


class _SubstitutionError(RobobtError, ValueError):
    """A substitution rule that does not fit the tree."""


class Robots(ScenarioPart):
    """The robots of both teams."""

    blue: tuple[RobotSetup, ...] = Field((), max_length=11, strict=False)
    yellow: tuple[RobotSetup, ...] = Field((), max_length=11, strict=False)

    @model_validator(mode="after")
    def _numbers_differ(self) -> Self:
        for team in Team:
            numbers: set[int] = set()
            for index, robot in enumerate(self.of(team)):
                if robot.number in numbers:
                    raise FieldError(
                        f"{team.value}.{index}.number", f"{team.value} has two robots {robot.number}"
                    )
                numbers.add(robot.number)
            keepers = [index for index, robot in enumerate(self.of(team)) if robot.goalkeeper]
            if len(keepers) > 1:
                raise FieldError(f"{team.value}.{keepers[1]}.goalkeeper", f"{team.value} has two goalkeepers")
        if not self.blue and not self.yellow:
            raise ValueError("there is no robot")
        return self

    def of(self, team: Team) -> tuple[RobotSetup, ...]:
        """Return the robots of one team."""
        return self.blue if team is Team.BLUE else self.yellow

    def replaced(self, changed: Mapping[RobotId, RobotSetup]) -> Robots:
        """Return the robots, some of them replaced, in the same order."""
        return Robots(
            blue=tuple([changed.get(RobotId(Team.BLUE, robot.number), robot) for robot in self.blue]),
            yellow=tuple([changed.get(RobotId(Team.YELLOW, robot.number), robot) for robot in self.yellow]),
        )

    def __iter__(self) -> Iterator[tuple[RobotId, RobotSetup]]:  # type: ignore[override]
        for team in Team:
            for robot in self.of(team):
                yield RobotId(team, robot.number), robot
