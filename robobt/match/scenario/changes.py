"""Scenarios with changed values, given by the file's field names, as command lines do."""

from __future__ import annotations

from collections.abc import Mapping

from pydantic import ValidationError

from robobt.config.errors import unknown_name
from robobt.config.validation import first_problem, nested
from robobt.match.scenario.robots import RobotSetup
from robobt.match.scenario.scenario import Scenario
from robobt.world.game import Team


def changed(scenario: Scenario, changes: Mapping[str, object]) -> Scenario:
    """Return the scenario with changed values.

    Names are the file's field names, with dots for nested fields (``ends.time_limit``, ``simulator.preset``).
    Names of a robot's fields begin with the robot (``blue 0.play``, ``yellow 0.limits.max_speed``); a name
    that is no field of a robot is a parameter of its play (``blue 0.rater``).

    Raises:
        ScenarioError: there is no such field, or the value does not fit.
    """
    for name, value in changes.items():
        owner, _, field = name.partition(".")
        words = owner.split()
        if words and words[0] in list(Team):
            scenario = _with_robot(scenario, " ".join(words), field, value)
        else:
            scenario = _with_field(scenario, name, value)
    return scenario


def with_team(scenario: Scenario, team: Team, play: str | None, params: Mapping[str, object]) -> Scenario:
    """Return the scenario with another play or parameters for a team's robots, except its goalkeeper.

    A goalkeeper without team-mates is changed too.

    Raises:
        ScenarioError: the team has no robot, or the play or a parameter does not fit.
    """
    robots = scenario.robots.of(team)
    if not robots:
        raise scenario.error("the team has no robot", f"robots.{team.value}")
    values = dict(params) if play is None else {"play": play, **params}
    for robot in [robot for robot in robots if not robot.goalkeeper] or robots:
        scenario = scenario.with_robot(f"{team.value} {robot.number}", **values)
    return scenario


def _with_robot(scenario: Scenario, robot: str, name: str, value: object) -> Scenario:
    if not name:
        raise scenario.error("takes a field or a parameter of the robot, as in 'blue 0.play'", robot)
    key, _, inner = name.partition(".")
    if inner:
        setups = {str(identity): setup for identity, setup in scenario.robots}
        value = nested(_current(setups.get(robot), key), inner, value)
    return scenario.with_robot(robot, **{key: _frozen(value) if key in RobotSetup.model_fields else value})


def _current(setup: RobotSetup | None, key: str) -> object:
    """Return a robot's field or its play's parameter; a parameter given by name as its mapping."""
    if setup is None or key in RobotSetup.model_fields:
        return getattr(setup, key, None)
    given = setup.params.get(key, setup.default_of(key))
    return {"name": given} if isinstance(given, str) else given


def _with_field(scenario: Scenario, name: str, value: object) -> Scenario:
    key, _, inner = name.partition(".")
    fields = [field for field in Scenario.model_fields if field != "robots"]
    if key not in fields:
        robots = [str(robot) for robot, _ in scenario.robots]
        groups = {field: type(getattr(scenario, field)) for field in fields}
        inside = [f"{field}.{name}" for field, of in groups.items() if key in getattr(of, "model_fields", ())]
        meant = f"did you mean {' or '.join(inside)}?" if inside else unknown_name(key, [*fields, *robots])
        raise scenario.error(f"there is no such field; {meant}", name)
    data = {field: getattr(scenario, field) for field in scenario.model_fields_set}
    data[key] = _frozen(nested(data.get(key), inner, value) if inner else value)
    try:
        validated = Scenario.model_validate(data)
    except ValidationError as error:
        field, problem = first_problem(error, Scenario, data)
        raise scenario.error(problem, field) from error
    return scenario.model_copy(update={key: getattr(validated, key)})


def _frozen(value: object) -> object:
    """Return plain data with tuples for lists, as in the fields of a scenario."""
    if isinstance(value, Mapping):
        return {name: _frozen(inner) for name, inner in value.items()}
    return tuple([_frozen(item) for item in value]) if isinstance(value, list | tuple) else value
