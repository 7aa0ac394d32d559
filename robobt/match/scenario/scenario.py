"""Scenario files: who plays what where, until when. YAML in, a validated :class:`Scenario` out."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, ValidationError, field_validator, model_validator

from robobt.config.errors import ConfigError, FieldError, RobobtError, message_of, one_line, short_repr
from robobt.config.resources import bundled_scenarios
from robobt.config.validation import first_problem
from robobt.config.yaml import read_yaml
from robobt.match.referee.settings import RefereeSettings
from robobt.match.scenario.placing import Placer, check_starts
from robobt.match.scenario.starts import BallStart, Part, RobotStart
from robobt.plays import PLAYS
from robobt.plays.files import find_play, is_play_file
from robobt.skills.store import GIVEN, Store
from robobt.tree import Behaviour, WiringError, check_tree
from robobt.tree.devtools import substitute
from robobt.tree.interop import TreeFileError
from robobt.tree.parameters import ParameterError, check_parameters
from robobt.world.field import DIVISION_B, FIELDS, FieldGeometry
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

MAX_TRIALS = 100_000
"""Most trials a scenario or a run may ask for."""

MAX_SEED = 2**53 - 1
"""Largest seed: what every JSON reader still reads exactly."""


class ScenarioError(ConfigError):
    """A scenario that cannot be played; the file is the scenario's name when it came from no file."""


class RobotSetup(Part):
    """One robot: its number, what it plays and where it starts."""

    number: int = Field(ge=0, le=15, description="number on its team")
    play: str = Field(max_length=400, description="its play: a name, or a tree file beside the scenario")
    params: dict[str, Any] = Field(default_factory=dict, description="parameters of the play")
    goalkeeper: bool = Field(False, description="whether it is its team's goalkeeper")
    limits: RobotLimits | None = Field(
        None, description="limits of this robot; those not given are the simulator's"
    )
    substitute: dict[str, Any] | str = Field(
        default_factory=dict,
        description="nodes of its tree that follow a script instead, by the pattern of their paths; "
        "or a file of such rules beside the scenario",
    )
    start: RobotStart = Field(description="pose at the start, in the own team's view")

    @field_validator("play")
    @classmethod
    def _known(cls, play: str) -> str:
        if not is_play_file(play) and play not in PLAYS:
            there = f"no play is called {short_repr(play)}; there are {', '.join(PLAYS)}"
            raise ValueError(PLAYS.problem_with(play) or there)
        return play

    @model_validator(mode="after")
    def _playable(self) -> Self:
        try:
            tree, another = self.build_tree(), self.build_tree()
            check_tree(tree, Store, GIVEN)
        except ParameterError as error:
            raise FieldError(f"params.{error.parameter}", str(error)) from error
        except _SubstitutionError as error:
            raise FieldError("substitute", message_of(error)) from error
        except (TreeFileError, WiringError) as error:
            raise FieldError("play", message_of(error)) from error
        except Exception as error:
            raise FieldError("params", message_of(error)) from error
        if {id(node) for node in tree.iterate()} & {id(node) for node in another.iterate()}:
            problem = "returns the same nodes each time; a play builds a new tree whenever it is called"
            raise FieldError("play", f"{self.play} {problem}")
        return self

    def build_tree(self) -> Behaviour:
        """A new tree of this robot's play."""
        builder = find_play(self.play)
        tree = builder(**check_parameters(self.play, builder, self.params))
        if not self.substitute:
            return tree
        try:
            return substitute(tree, self.substitute)
        except TreeFileError as error:
            # Rules in the scenario itself are in no file of their own.
            told = str(error) if isinstance(self.substitute, str) else error.problem
            raise _SubstitutionError(told) from error

    def limits_over(self, base: RobotLimits) -> RobotLimits:
        """The robot's limits where ``base`` holds for those the scenario leaves out."""
        if self.limits is None:
            return base
        return base.model_copy(update=self.limits.model_dump(exclude_unset=True))


class _SubstitutionError(RobobtError, ValueError):
    """A rule for nodes to be replaced is wrong."""


class Robots(Part):
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
        """The robots of one team."""
        return self.blue if team is Team.BLUE else self.yellow

    def __iter__(self) -> Iterator[tuple[RobotId, RobotSetup]]:  # type: ignore[override]
        for team in Team:
            for robot in self.of(team):
                yield RobotId(team, robot.number), robot


class Ends(Part):
    """What ends a trial; the first that happens."""

    time_limit: float = Field(gt=0, le=3600, description="longest trial [s]")
    goal: bool | None = Field(None, description="a goal; by default where there is no referee")
    ball_out: bool | None = Field(
        None, description="the ball has left the field in full; by default where there is no referee"
    )
    held_by_goalkeeper: float | None = Field(
        None, ge=0, le=60, description="a goalkeeper has had the ball for this long, or has kicked it [s]"
    )
    ball_at_rest: float | None = Field(
        None, ge=0, le=60, description="after a kick the ball has lain still for this long [s]"
    )
    score_limit: int | None = Field(None, ge=1, le=100, description="a team has this many goals")


class Scenario(Part):
    """One set-up that can be played any number of times.

    A robot's start is in its own team's view (own goal at -x), the ball's in
    world coordinates, which are blue's view. SI units.
    """

    name: str = Field("", max_length=80, description="what it is called; by default the file's name")
    description: str = Field("", max_length=2000)
    field: FieldGeometry = Field(DIVISION_B, description="a preset's name or dimensions [m]")
    simulator: dict[str, Any] = Field(
        default_factory=lambda: {"preset": "default"},
        description="a preset's name, or preset, realism and settings to change; for the world factory",
    )
    period: float = Field(0.025, ge=0.005, le=0.1, description="control period [s]")
    predict: bool = Field(
        True,
        description="whether a team that sees late is shown where everything is by now, as follows from "
        "the commands on their way",
    )
    seed: int = Field(0, ge=0, le=MAX_SEED, description="what every trial's randomness follows from")
    trials: int = Field(1, ge=1, le=MAX_TRIALS, description="how often it is played unless told otherwise")
    robots: Robots
    ball: BallStart = Field(BallStart(position=(0.0, 0.0)), description="where the ball starts")
    clearance: float = Field(
        0.05, ge=0, le=2, description="least gap between hulls, and to the ball, for random starts [m]"
    )
    ends: Ends
    referee: RefereeSettings | None = Field(
        None, description="true or settings for a referee on the field, none for free play"
    )
    on_error: Literal["stop", "raise"] = Field(
        "stop",
        description="what an exception in a tree does: stop that robot for the tick, or end the match",
    )
    _source: str = PrivateAttr("")

    @field_validator("name")
    @classmethod
    def _printable(cls, name: str) -> str:
        if not name.isprintable():
            raise ValueError("a name has to be printable and on one line")
        return name

    @field_validator("field", mode="before")
    @classmethod
    def _field_by_name(cls, value: Any) -> Any:
        if not isinstance(value, str):
            return value
        if value not in FIELDS:
            raise ValueError(f"no field is called {short_repr(value)}; there are {', '.join(FIELDS)}")
        return FIELDS[value]

    @field_validator("simulator", mode="before")
    @classmethod
    def _simulator_by_name(cls, value: Any) -> Any:
        return {"preset": value} if isinstance(value, str) else value

    @field_validator("referee", mode="before")
    @classmethod
    def _referee_or_not(cls, value: Any) -> Any:
        return {True: {}, False: None}[value] if isinstance(value, bool) else value

    @model_validator(mode="after")
    def _startable(self) -> Self:
        if self.ends.score_limit is not None and self.referee is None:
            raise FieldError("ends.score_limit", "needs the referee, who restarts play after a goal")
        check_starts(self.field, self._starts, self.ball)
        self._placer(np.random.default_rng(0)).place()
        return self

    @property
    def _starts(self) -> dict[RobotId, RobotStart]:
        return {robot: setup.start for robot, setup in self.robots}

    def _placer(self, rng: np.random.Generator) -> Placer:
        return Placer(self.field, self._starts, self.ball, self.clearance, rng)

    @property
    def source(self) -> str:
        """The file it came from, or its name."""
        return self._source or self.name or "scenario"

    def error(self, problem: str, field: str = "") -> ScenarioError:
        """An error about this scenario."""
        return ScenarioError(self.source, problem, field)

    def lasting(self, time_limit: float) -> Scenario:
        """The same scenario with another time limit [s]."""
        return self.model_copy(update={"ends": self.ends.model_copy(update={"time_limit": time_limit})})

    def goalkeepers(self) -> dict[Team, int]:
        """Numbers of the teams' goalkeepers, for teams that have one."""
        return {robot.team: robot.number for robot, setup in self.robots if setup.goalkeeper}

    def place(self, rng: np.random.Generator) -> Placement:
        """Where everything stands in one trial, in world coordinates.

        Raises:
            ScenarioError: an object found no free place in a bounded number of tries.
        """
        try:
            return self._placer(rng).place()
        except FieldError as error:
            raise self.error(str(error), error.field) from error


def load_scenario(source: str | Path) -> Scenario:
    """A scenario from a YAML file or, where there is no such file, a bundled one by its name.

    Raises:
        ScenarioError: one line that names the file and the field or line.
    """
    path = Path(source)
    bundled = bundled_scenarios()
    if isinstance(source, str) and source in bundled and not path.exists():
        path = bundled[source]
    where = one_line(str(source if path.name == path.stem else path))
    try:
        missing = not path.exists()
    except (OSError, ValueError):
        missing = True
    if missing:
        raise ScenarioError(where, f"no such file or bundled scenario; bundled are {', '.join(bundled)}")
    data = read_yaml(path, ScenarioError)
    # From here, not from the scenario's folder.
    rename_files(data, lambda file: str(path.parent / file))
    scenario = scenario_from(data, str(path))
    return scenario if scenario.name else _named(scenario, path.stem)


def scenario_from(data: object, source: str) -> Scenario:
    """A scenario from plain data, as a YAML or JSON file holds it.

    Args:
        source: what messages call it.

    Raises:
        ScenarioError: one line that names the source and the field.
    """
    if not isinstance(data, dict):
        raise ScenarioError(source, "a scenario is a mapping of fields")
    try:
        # Strict JSON: lists fit tuples, integers fit floats, and nothing else is converted.
        scenario = Scenario.model_validate_json(json.dumps(data), strict=True)
    except ValidationError as error:
        field, problem = first_problem(error, Scenario, data)
        raise ScenarioError(source, problem, field) from error
    scenario._source = source
    return scenario


def rename_files(data: object, rename: Callable[[str], str]) -> None:
    """Call the robots' files (trees, substitution rules) otherwise in a scenario's plain data."""
    robots = data.get("robots") if isinstance(data, dict) else None
    for team in robots.values() if isinstance(robots, dict) else ():
        for robot in team if isinstance(team, list) else ():
            if not isinstance(robot, dict):
                continue
            play, rules = robot.get("play"), robot.get("substitute")
            if isinstance(play, str) and is_play_file(play):
                robot["play"] = rename(play)
            if isinstance(rules, str):
                robot["substitute"] = rename(rules)


def _named(scenario: Scenario, name: str) -> Scenario:
    named = scenario.model_copy(update={"name": name})
    named._source = scenario._source
    return named
