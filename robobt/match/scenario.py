"""Scenario files: who plays what where, until when. YAML in, a validated :class:`Scenario` out."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from math import cos, hypot, pi, sin
from pathlib import Path
from typing import Any, Self, get_args

import numpy as np
from pydantic import BaseModel, Field, PrivateAttr, ValidationError, field_validator, model_validator

from robobt.match.parameters import ParameterError, check_parameters, say_value
from robobt.match.referee import RefereeSettings
from robobt.match.starts import Around, BallStart, Box, Disc, Part, RobotStart
from robobt.match.yaml_reader import YamlError, read_yaml
from robobt.plays import PLAYS
from robobt.resources import bundled_scenarios
from robobt.tree import Behaviour
from robobt.world.field import DIVISION_B, FIELDS, FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.protocol import Placement
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotId

MAX_TRIALS = 100_000
"""Most trials a scenario or a run may ask for."""

MAX_SEED = 2**53 - 1
"""Largest seed: what every JSON reader still reads exactly."""

HELD_DISTANCE = 0.098
"""Centre of a robot to the centre of the ball in its mouth at the start [m]."""

_TRIES = 1000


class ScenarioError(ValueError):
    """Something is wrong with a scenario; the message is one line.

    Attributes:
        source: the file, or the scenario's name.
        field: where in it ("robots.blue.0.play"), empty when it is not one field.
    """

    def __init__(self, source: str, problem: str, field: str = "") -> None:
        self.source, self.field = source, field
        parts = [source, field, problem] if field else [source, problem]
        super().__init__(_one_line(": ".join(parts)))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restore, (self.source, self.field, str(self)))


def _restore(source: str, field: str, message: str) -> ScenarioError:
    # An exception is pickled by its message, which is not what its constructor takes.
    error = ScenarioError(source, "", field)
    error.args = (message,)
    return error


class _FieldError(ValueError):
    """A problem with a field further down than the one that is being validated."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(problem)
        self.field = field


class RobotSetup(Part):
    """One robot: its number, what it plays and where it starts."""

    number: int = Field(ge=0, le=15, description="number on its team")
    play: str = Field(max_length=80, description="name of its play")
    params: dict[str, Any] = Field(default_factory=dict, description="parameters of the play")
    goalkeeper: bool = Field(False, description="whether it is its team's goalkeeper")
    limits: RobotLimits | None = Field(
        None, description="limits of this robot; those not given are the simulator's"
    )
    start: RobotStart = Field(description="pose at the start, in the own team's view")

    @field_validator("play")
    @classmethod
    def _known(cls, play: str) -> str:
        if play not in PLAYS:
            raise ValueError(f"no play is called {say_value(play)}; there are {', '.join(PLAYS)}")
        return play

    @model_validator(mode="after")
    def _playable(self) -> Self:
        try:
            self.build_tree()
        except ParameterError as error:
            raise _FieldError(f"params.{error.parameter}", str(error)) from error
        except Exception as error:
            raise _FieldError("params", _message(error)) from error
        return self

    def build_tree(self) -> Behaviour:
        """A new tree of this robot's play."""
        builder = PLAYS[self.play]
        return builder(**check_parameters(self.play, builder, self.params))

    def limits_over(self, base: RobotLimits) -> RobotLimits:
        """The robot's limits where ``base`` holds for those the scenario leaves out."""
        if self.limits is None:
            return base
        return base.model_copy(update=self.limits.model_dump(exclude_unset=True))


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
                    raise _FieldError(
                        f"{team.value}.{index}.number", f"{team.value} has two robots {robot.number}"
                    )
                numbers.add(robot.number)
            keepers = [index for index, robot in enumerate(self.of(team)) if robot.goalkeeper]
            if len(keepers) > 1:
                raise _FieldError(
                    f"{team.value}.{keepers[1]}.goalkeeper", f"{team.value} has two goalkeepers"
                )
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
        None, ge=0, le=60, description="a goalkeeper has had the ball for this long [s]"
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
            raise ValueError(f"no field is called {say_value(value)}; there are {', '.join(FIELDS)}")
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
            raise _FieldError("ends.score_limit", "needs the referee, who restarts play after a goal")
        _check_places(self)
        _Placer(self, np.random.default_rng(0)).place()
        return self

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
            return _Placer(self, rng).place()
        except _FieldError as error:
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
    where = _one_line(str(source if path.name == path.stem else path))
    try:
        missing = not path.exists()
    except (OSError, ValueError):
        missing = True
    if missing:
        raise ScenarioError(where, f"no such file or bundled scenario; bundled are {', '.join(bundled)}")
    try:
        data = read_yaml(path)
    except YamlError as error:
        raise ScenarioError(str(path), str(error)) from error
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
        field, problem = _first_problem(error, data)
        raise ScenarioError(source, problem, field) from error
    scenario._source = source
    return scenario


def _named(scenario: Scenario, name: str) -> Scenario:
    named = scenario.model_copy(update={"name": name})
    named._source = scenario._source
    return named


class _Placer:
    """Samples one placement: what is fixed first, then the ball, then the other robots."""

    def __init__(self, scenario: Scenario, rng: np.random.Generator) -> None:
        self.scenario, self.rng, self.field = scenario, rng, scenario.field
        self.taken: list[tuple[float, float, float]] = []
        self.robots: dict[RobotId, tuple[float, float, float]] = {}
        self.ball: Point | None = None
        self.setups = dict(scenario.robots)

    def place(self) -> Placement:
        ball = self.scenario.ball
        holder = _robot_called(ball.held_by)
        fixed = [robot for robot, setup in self.setups.items() if setup.start.fixed]
        if isinstance(ball.position, tuple):
            self.ball = ball.position
            self.taken.append((*self.ball, BALL_RADIUS))
        for robot in fixed:
            self._take(robot, self._world(robot, self._fixed_place(robot)))
        if holder is not None:
            if holder not in fixed:
                self._sample_robot(holder)
            self._face(holder)
            x, y, heading = self.robots[holder]
            self.ball = (x + HELD_DISTANCE * cos(heading), y + HELD_DISTANCE * sin(heading))
            self.taken.append((*self.ball, BALL_RADIUS))
        elif self.ball is None:
            self._sample_ball()
        for robot in self.setups:
            if robot not in self.robots:
                self._sample_robot(robot)
            if robot != holder:
                self._face(robot)
        assert self.ball is not None
        return Placement({robot: self.robots[robot] for robot in self.setups}, (*self.ball, *ball.velocity))

    def _fixed_place(self, robot: RobotId) -> Point:
        place = self.setups[robot].start.position
        assert isinstance(place, tuple)
        return place

    def _sample_robot(self, robot: RobotId) -> None:
        position = self.setups[robot].start.position
        holds = _robot_called(self.scenario.ball.held_by) == robot
        for _ in range(_TRIES):
            if isinstance(position, Around):
                own_ball = None if self.ball is None else self._world(robot, self.ball)
                middle = {"own goal": self.field.our_goal, "their goal": self.field.their_goal}.get(
                    position.around, own_ball
                )
                assert middle is not None
                place = position.sample(self.rng, middle)
            else:
                assert isinstance(position, Box | Disc)
                place = position.sample(self.rng)
            x, y = self._world(robot, place)
            # The ball in its mouth needs room too, whichever way it looks.
            if self._free(x, y, ROBOT_RADIUS + (2 * BALL_RADIUS if holds else 0.0)):
                self._take(robot, (x, y))
                return
        raise _FieldError(f"robots.{_index(self.scenario, robot)}.start", _full(position))

    def _sample_ball(self) -> None:
        position = self.scenario.ball.position
        assert isinstance(position, Box | Disc)
        for _ in range(_TRIES):
            x, y = position.sample(self.rng)
            if self._free(x, y, BALL_RADIUS):
                self.ball = (x, y)
                self.taken.append((x, y, BALL_RADIUS))
                return
        raise _FieldError("ball.position", _full(position))

    def _free(self, x: float, y: float, radius: float) -> bool:
        gap = radius + self.scenario.clearance
        return self.field.contains(x, y) and all(
            hypot(x - other_x, y - other_y) >= gap + other for other_x, other_y, other in self.taken
        )

    def _take(self, robot: RobotId, place: Point) -> None:
        self.robots[robot] = (*place, 0.0)
        self.taken.append((*place, ROBOT_RADIUS))

    def _face(self, robot: RobotId) -> None:
        x, y, _ = self.robots[robot]
        own_ball = None if self.ball is None else self._world(robot, self.ball)
        heading = self.setups[robot].start.sample_heading(
            self.rng, self._world(robot, (x, y)), own_ball, self.field
        )
        self.robots[robot] = (x, y, wrap_angle(heading + (pi if robot.team is Team.YELLOW else 0.0)))

    def _world(self, robot: RobotId, place: Point) -> Point:
        """From the robot's view to the world's, or back: half a turn is its own inverse."""
        return place if robot.team is Team.BLUE else (-place[0], -place[1])


def _full(position: object) -> str:
    return f"no free place {position} found in {_TRIES} tries"


def _check_places(scenario: Scenario) -> None:
    """Raise on what no random number can help: places off the field, fixed starts that overlap."""
    field = scenario.field
    taken: list[tuple[str, float, float, float]] = []
    ball = scenario.ball
    holder = _robot_called(ball.held_by)
    if ball.position is not None:
        _check_inside(ball.position, field, "ball.position")
        if isinstance(ball.position, tuple):
            taken.append(("the ball", *ball.position, BALL_RADIUS))
    elif holder is None or holder not in dict(scenario.robots):
        there = ", ".join([str(robot) for robot, _ in scenario.robots])
        raise _FieldError("ball.held_by", f"no robot is called {say_value(ball.held_by)}; there are {there}")
    for robot, setup in scenario.robots:
        where = f"robots.{_index(scenario, robot)}.start"
        position = setup.start.position
        _check_inside(position, field, f"{where}.position")
        if robot == holder and isinstance(position, Around) and position.around == "ball":
            raise _FieldError(f"{where}.position", "it holds the ball, so it cannot start around the ball")
        if robot == holder and setup.start.heading == "towards ball":
            raise _FieldError(f"{where}.heading", "it holds the ball, so it cannot turn towards the ball")
        if isinstance(position, tuple):
            sign = 1.0 if robot.team is Team.BLUE else -1.0
            x, y = sign * position[0], sign * position[1]
            for other, other_x, other_y, radius in taken:
                if hypot(x - other_x, y - other_y) < ROBOT_RADIUS + radius:
                    hint = " (to start with it in the mouth, use held_by)" if other == "the ball" else ""
                    raise _FieldError(where, f"{robot} would overlap {other}{hint}")
            taken.append((str(robot), x, y, ROBOT_RADIUS))


def _check_inside(position: object, field: FieldGeometry, where: str) -> None:
    points: Sequence[Point] = ()
    if isinstance(position, Box):
        points = [(x, y) for x in position.x for y in position.y]
    elif isinstance(position, Disc):
        points = [position.center]
    elif isinstance(position, tuple):
        points = [position]
    for x, y in points:
        if not field.contains(x, y):
            size = f"{field.length:g} m x {field.width:g} m"
            raise _FieldError(where, f"({x:g}, {y:g}) lies outside the field, which is {size} around (0, 0)")


def _robot_called(name: str | None) -> RobotId | None:
    team, _, number = (name or "").partition(" ")
    return RobotId(Team(team), int(number)) if team in set(Team) and number in _NUMBERS else None


_NUMBERS = frozenset(str(number) for number in range(16))


def _index(scenario: Scenario, robot: RobotId) -> str:
    numbers = [setup.number for setup in scenario.robots.of(robot.team)]
    return f"{robot.team.value}.{numbers.index(robot.number)}"


def _first_problem(error: ValidationError, data: object) -> tuple[str, str]:
    """Field and message of the first problem, and how many more there are."""
    problems = error.errors(include_url=False)
    problem = problems[0]
    place = _real_place(problem["loc"], data)
    cause = problem.get("ctx", {}).get("error")
    message = problem["msg"].replace("valid array", "list").replace("an object", "a mapping")
    if isinstance(cause, Exception):
        message = _message(cause)
        if isinstance(cause, _FieldError):
            place += cause.field.split(".")
    elif problem["type"] == "missing":
        message = "is missing"
    elif problem["type"] == "extra_forbidden":
        message = f"there is no such field; there are {', '.join(_fields_at(problem['loc'][:-1]))}"
    elif not isinstance(problem["input"], Mapping | list):
        message = f"{message}, not {say_value(problem['input'])}"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return ".".join(place), message[:1].lower() + message[1:] + more


def _real_place(loc: tuple[int | str, ...], data: object) -> list[str]:
    """The way to the field without the names of the union's members that pydantic puts in."""
    place: list[str] = []
    for depth, part in enumerate(loc):
        inside = isinstance(data, dict) and part in data
        if inside or (isinstance(data, list) and isinstance(part, int) and part < len(data)):
            place.append(str(part))
            data = data[part]  # type: ignore[index]
        elif depth == len(loc) - 1 and isinstance(data, dict | list):
            place.append(str(part))
    return place


def _fields_at(loc: tuple[int | str, ...]) -> list[str]:
    """The fields that the part of a scenario at ``loc`` may have."""
    models: list[type[BaseModel]] = [Scenario]
    for part in loc:
        below = [hint.annotation for model in models if (hint := model.model_fields.get(str(part)))]
        if below:
            models = [model for hint in below for model in _models_in(hint)]
        else:
            # A place in a list, or the name of a union's member.
            models = [model for model in models if model.__name__.lower() == part] or models
    return [name for model in models for name in model.model_fields]


def _models_in(hint: object) -> list[type[BaseModel]]:
    if isinstance(hint, type) and issubclass(hint, BaseModel):
        return [hint]
    return [model for part in get_args(hint) for model in _models_in(part)]


def _message(error: Exception) -> str:
    # str(KeyError) is the repr of its message.
    return str(error.args[0]) if error.args else type(error).__name__


def _one_line(text: str) -> str:
    words = " ".join(text.split())
    said = "".join([character if character.isprintable() else "?" for character in words])
    return said if len(said) <= 500 else said[:497] + "..."
