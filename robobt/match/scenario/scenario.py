"""Scenario files: YAML with robots, plays, starts and ends, read as a validated :class:`Scenario`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Literal, Self

import numpy as np
from pydantic import Field, PrivateAttr, ValidationError, field_validator, model_validator

from robobt.config.errors import ConfigError, FieldError, one_line, short_repr, unknown_name
from robobt.config.resources import bundled_scenarios
from robobt.config.seeds import MAX_SEED as MAX_SEED
from robobt.config.validation import first_problem
from robobt.config.wording import counted
from robobt.config.yaml import read_yaml
from robobt.match.referee.settings import RefereeSettings
from robobt.match.scenario.placing import Placer, check_inside, check_starts
from robobt.match.scenario.robots import UNBUILT, Robots, RobotSetup
from robobt.match.scenario.starts import BallStart, RobotStart, ScenarioPart
from robobt.models.find import rename_models
from robobt.plays.files import rename_play
from robobt.world.field import DIVISION_B, FIELDS, FieldGeometry
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId

MAX_TRIALS = 100_000
"""Largest number of trials of a scenario or a run."""


class ScenarioError(ConfigError):
    """A scenario cannot be played; ``file`` is the scenario's name if it came from no file."""


class Ends(ScenarioPart):
    """Conditions that end a trial; the first one that is met ends it."""

    time_limit: float = Field(gt=0, le=3600, description="longest trial [s]")
    goal: bool | None = Field(None, description="a goal; by default where there is no referee")
    ball_out: bool | None = Field(
        None, description="the ball has left the field in full; by default where there is no referee"
    )
    held_by_goalkeeper: float | None = Field(
        None, ge=0, le=60, description="a goalkeeper has had the ball for this time, or has kicked it [s]"
    )
    ball_at_rest: float | None = Field(
        None, ge=0, le=60, description="after a kick the ball has been at rest for this time [s]"
    )
    score_limit: int | None = Field(None, ge=1, le=100, description="a team has this many goals")
    placement: bool = Field(False, description="a ball placement is over, whether it succeeded or not")


class Scenario(ScenarioPart):
    """A set-up for matches that can be played any number of times.

    A robot's start is in its own team's view (own goal at -x), the ball's in
    world coordinates, which are blue's view. SI units.
    """

    name: str = Field("", max_length=80, description="name of the scenario; by default the file's name")
    description: str = Field("", max_length=2000)
    field: FieldGeometry = Field(DIVISION_B, description="a preset's name or dimensions [m]")
    simulator: dict[str, object] = Field(
        {"preset": "default"},
        description="a preset's name, or preset, realism and changed settings; for the world factory",
    )
    period: float = Field(0.025, ge=0.005, le=0.1, description="control period [s]")
    predict: bool | Literal["measured"] = Field(
        True,
        description="whether delayed frames are predicted to the present from the commands on their way; "
        "measured: by delays that are measured while the robots play",
    )
    seed: int = Field(0, ge=0, le=MAX_SEED, description="seed from which every trial's randomness is derived")
    trials: int = Field(1, ge=1, le=MAX_TRIALS, description="default number of trials")
    robots: Robots
    ball: BallStart = Field(BallStart(position=(0.0, 0.0)), description="start of the ball")
    clearance: float = Field(
        0.05, ge=0, le=2, description="least gap between hulls, and to the ball, for random starts [m]"
    )
    ends: Ends
    referee: RefereeSettings | None = Field(
        None, description="true or settings for a referee on the field, none for free play"
    )
    on_error: Literal["stop", "raise"] = Field(
        "stop", description="effect of an exception in a tree: stop that robot for the tick, or end the match"
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
    def _field_by_name(cls, value: object) -> object:
        if not isinstance(value, str):
            return value
        if value not in FIELDS:
            raise ValueError(f"no field is called {short_repr(value)}; {unknown_name(value, FIELDS)}")
        return FIELDS[value]

    @field_validator("predict", mode="before")
    @classmethod
    def _predicted(cls, value: object) -> object:
        if not isinstance(value, bool) and value != "measured":
            raise ValueError(f"takes true, false or measured, not {short_repr(value)}")
        return value

    @field_validator("simulator", mode="before")
    @classmethod
    def _simulator_by_name(cls, value: object) -> object:
        return {"preset": value} if isinstance(value, str) else value

    @field_validator("referee", mode="before")
    @classmethod
    def _referee_or_not(cls, value: object) -> object:
        return {True: {}, False: None}[value] if isinstance(value, bool) else value

    @model_validator(mode="after")
    def _startable(self) -> Self:
        if self.ends.score_limit is not None and self.referee is None:
            raise FieldError("ends.score_limit", "needs the referee, who restarts play after a goal")
        if self.ends.placement and self.referee is None:
            raise FieldError("ends.placement", "needs the referee, who asks for it")
        spot = None if self.referee is None else self.referee.opening_spot
        if isinstance(spot, tuple):
            check_inside(spot, self.field, "referee.opening_spot")
        if self.referee is not None:
            self._check_endless(self.referee)
        self._check_starts()
        return self

    def _check_endless(self, referee: RefereeSettings) -> None:
        """Refuse settings for which a referee would wait forever."""
        robots = {robot for robot, _ in self.robots}
        for team in Team:
            there = sum(robot.team is team for robot in robots)
            if referee.max_robots is not None and there > referee.max_robots:
                problem = f"is {referee.max_robots}, but {team.value} has {counted(there, 'robot')}"
                raise FieldError("referee.max_robots", problem)
        kicking = {"penalty": [referee.opening_team], "shoot_out": list(Team)}.get(referee.opening, [])
        keepers = self.goalkeepers()
        for team in Team if referee.shoot_out else [team.other for team in kicking]:
            if RobotId(team, keepers.get(team, referee.keeper(team).number)) not in robots:
                raise FieldError(
                    "referee.shoot_out" if referee.shoot_out else "referee.opening",
                    f"waits for {team.value}'s goalkeeper, which is not there; give one of its robots "
                    "'goalkeeper: true'",
                )

    def _check_starts(self) -> None:
        check_starts(self.field, self._starts, self.ball)
        self._placer(np.random.default_rng(0)).place()

    @property
    def _starts(self) -> dict[RobotId, RobotStart]:
        return {robot: setup.start for robot, setup in self.robots}

    def _placer(self, rng: np.random.Generator) -> Placer:
        return Placer(self.field, self._starts, self.ball, self.clearance, rng)

    @property
    def source(self) -> str:
        """Return the scenario's file, or its name without a file."""
        return self._source or self.name or "scenario"

    def error(self, problem: str, field: str = "") -> ScenarioError:
        """Return an error about this scenario: the ``problem`` and its ``field``, if any."""
        return ScenarioError(self.source, problem, field)

    def with_robot(self, robot: str | RobotId, /, **changes: object) -> Scenario:
        """Return the scenario with one robot changed; this scenario stays unchanged.

        ``scenario.with_robot("blue 0", rater="open_angle")`` gives its play another parameter,
        ``scenario.with_robot("blue 0", play="attack_nn", limits={"max_speed": 2.0})`` changes the robot
        itself. Everything not named stays, including the play's other parameters; a new play keeps the
        parameters that it also has.

        Args:
            robot: which robot, as "blue 0".
            **changes: fields of :class:`RobotSetup`; any other name is a parameter of the play.

        Raises:
            ScenarioError: there is no such robot, the play has no such parameter, or a value
                does not fit; the message names the robot and the field.
        """
        name = " ".join(str(robot).split())
        named = {str(identity): (identity, setup) for identity, setup in self.robots}
        if name not in named:
            raise self.error(f"there is no robot {name!r}; {unknown_name(name, named)}", "robots")
        identity, setup = named[name]
        place = f"robots.{identity.team.value}.{self.robots.of(identity.team).index(setup)}"
        try:
            replacement = setup.changed(changes)
        except ValidationError as error:
            field, problem = first_problem(error, RobotSetup, changes)
            raise self.error(f"{name}: {problem}", f"{place}.{field}") from error
        try:
            changed = self.model_copy(update={"robots": self.robots.replaced({identity: replacement})})
            changed._check_starts()
        except ValidationError as error:
            field, problem = first_problem(error, Robots, {})
            raise self.error(problem, f"robots.{field}") from error
        except FieldError as error:
            raise self.error(str(error), error.field) from error
        return changed

    def lasting(self, time_limit: float) -> Scenario:
        """Return the scenario with another ``time_limit`` [s]."""
        return self.model_copy(update={"ends": self.ends.model_copy(update={"time_limit": time_limit})})

    def without_referee(self) -> Scenario:
        """Return the scenario without its own referee, for matches under a game controller."""
        return self.model_copy(update={"referee": None})

    def goalkeepers(self) -> dict[Team, int]:
        """Return the goalkeepers' numbers, for teams that have one."""
        return {robot.team: robot.number for robot, setup in self.robots if setup.goalkeeper}

    def place(self, rng: np.random.Generator) -> Placement:
        """Sample the placement of one trial, in world coordinates, from ``rng``.

        Raises:
            ScenarioError: no free place was found for an object in a limited number of tries.
        """
        try:
            return self._placer(rng).place()
        except FieldError as error:
            raise self.error(str(error), error.field) from error


def load_scenario(source: str | Path, *, build: bool = True) -> Scenario:
    """Load a scenario from a YAML file or, if there is no such file, a bundled one by its name.

    Args:
        source: the file, or the name of a bundled scenario.
        build: whether to check that the robots' trees can be built, which loads their models.

    Raises:
        ScenarioError: the file cannot be read or is no scenario; it names the field or line.
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
        raise ScenarioError(where, f"no such file or bundled scenario; {unknown_name(where, bundled)}")
    data = read_yaml(path, ScenarioError)
    # Relative to the working folder, not to the scenario's folder.
    rename_files(data, lambda file: str(path.parent / file))
    scenario = scenario_from(data, str(path), build=build)
    return scenario if scenario.name else scenario.model_copy(update={"name": path.stem})


def scenario_from(data: object, source: str, *, build: bool = True) -> Scenario:
    """Make a scenario from the plain data of a YAML or JSON file; with ``build`` its trees too.

    Raises:
        ScenarioError: the data is no scenario; the message names the source and the field.
    """
    if not isinstance(data, dict):
        raise ScenarioError(source, "a scenario is a mapping of fields")
    try:
        # Strict JSON: lists are accepted as tuples, integers as floats, and nothing else is converted.
        scenario = Scenario.model_validate_json(
            json.dumps(data), strict=True, context=None if build else UNBUILT
        )
    except ValidationError as error:
        field, problem = first_problem(error, Scenario, data)
        raise ScenarioError(source, problem, field) from error
    scenario._source = source
    return scenario


def rename_files(data: object, rename: Callable[[str], str]) -> None:
    """Rename the robots' files (trees, Python files, models, rules) in a scenario's plain data."""
    robots = data.get("robots") if isinstance(data, dict) else None
    for team in robots.values() if isinstance(robots, dict) else ():
        for robot in team if isinstance(team, list) else ():
            if not isinstance(robot, dict):
                continue
            play, rules = robot.get("play"), robot.get("substitute")
            if isinstance(play, str):
                robot["play"] = rename_play(play, rename)
            if isinstance(rules, str):
                robot["substitute"] = rename(rules)
            if "params" in robot:
                robot["params"] = rename_models(robot["params"], rename)
