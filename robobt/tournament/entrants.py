"""The entrants of a tournament: the plays of a side's robots, for either side and any scenario."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Self

from pydantic import Field, ValidationError, field_validator, model_validator

from robobt.config.errors import ConfigError, FieldError, close_names
from robobt.config.resources import bundled_scenarios, models_folder
from robobt.config.validation import Settings, first_problem
from robobt.config.yaml import read_yaml
from robobt.league.programs.program import Program
from robobt.match.scenario.robots import RobotSetup
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.models.file import ModelError
from robobt.models.find import find_model, rename_models
from robobt.plays import PLAYS
from robobt.plays.files import contents_of, is_play_file, problem_with_play, rename_play
from robobt.plays.private_files import join_play, split_play
from robobt.world.game import Team

_ENTRANT_FIELD = "entrant"
"""The field that distinguishes an entrant's file from a play's file."""


class EntrantError(ConfigError):
    """An entrant cannot take part; the message is one line that names its file or text."""


class RobotPlay(Settings):
    """The play of one robot."""

    play: str = Field(
        max_length=4000,
        description="a play's name, or a file beside the entrant's: a tree, or a play in Python, as "
        "my_team.py:striker",
    )
    params: dict[str, object] = Field(default_factory=dict, description="parameters of the play")


class EntrantFile(Settings):
    """The YAML file of an entrant."""

    entrant: str = Field(min_length=1, max_length=80, description="what it is called")
    players: tuple[RobotPlay, ...] = Field(
        (),
        max_length=11,
        strict=False,
        description="the field players in the scenario's order; the last one is also all that follow",
    )
    goalkeeper: RobotPlay | None = Field(None, description="the goalkeeper; by default the scenario's")
    program: Program | None = Field(
        None, description="instead of players: a program that commands the robots over the league's protocols"
    )
    imports: tuple[str, ...] = Field(
        (),
        strict=False,
        description="Python files beside this one; what they register is this entrant's alone",
    )

    @field_validator("entrant")
    @classmethod
    def _printable(cls, name: str) -> str:
        if not name.isprintable() or name != name.strip():
            raise ValueError("a name has to be printable, on one line, without blanks around it")
        return name

    @model_validator(mode="after")
    def _plays(self) -> Self:
        if self.program is None and not self.players:
            raise FieldError("players", "is missing, and there is no program either")
        if self.program is not None and (self.players or self.goalkeeper):
            raise FieldError("program", "plays all robots: leave players and goalkeeper out")
        return self


@dataclass(slots=True, frozen=True)
class Entrant:
    """A team that can play either side of any scenario.

    Attributes:
        name: name in tables.
        source: the file or text it comes from.
        players: plays of the field players, in the scenario's order; the last one also applies to all further
            players.
        goalkeeper: play of the goalkeeper; None for the play of blue's goalkeeper in the scenario.
        program: the program that commands its robots; None if they play trees.
    """

    name: str
    source: str
    players: tuple[RobotPlay, ...]
    goalkeeper: RobotPlay | None = None
    program: Program | None = None

    def error(self, problem: str, field: str = "") -> EntrantError:
        """Make an error about this entrant."""
        return EntrantError(self.source, problem, field)

    @property
    def parts(self) -> list[RobotPlay]:
        """Return what each of its robots plays, the goalkeeper last."""
        return [*self.players, *([self.goalkeeper] if self.goalkeeper else [])]

    def to_json(self) -> str:
        """Return it as JSON, without the contents of its files; the inverse of :meth:`from_json`."""
        given: dict[str, object] = {"name": self.name, "source": self.source}
        given["players"] = [part.model_dump(mode="json") for part in self.players]
        for field in ("goalkeeper", "program"):
            part = getattr(self, field)
            given[field] = None if part is None else part.model_dump(mode="json")
        return json.dumps(given, separators=(",", ":"))

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Return the entrant of such JSON."""
        given = json.loads(text)
        goalkeeper, program = given["goalkeeper"], given["program"]
        return cls(
            given["name"],
            given["source"],
            tuple([RobotPlay.model_validate(part) for part in given["players"]]),
            None if goalkeeper is None else RobotPlay.model_validate(goalkeeper),
            None if program is None else Program.model_validate(program, strict=False),
        )

    def digest(self) -> str:
        """Hash its plays, with files' contents: an edited tree or another model makes another team."""
        parts = self.parts
        says: list[Any] = [
            part and part.model_dump() for part in (*self.players, self.goalkeeper, self.program)
        ]
        for said, part in zip(says, parts, strict=False):
            # Python files and models count by what they hold, wherever they lie.
            said["play"] = split_play(part.play)[1]
            said["params"] = rename_models(part.params, lambda file: Path(file).name)
        digest = hashlib.blake2b(json.dumps(says, sort_keys=True).encode(), digest_size=16)
        for part in parts:
            for content in contents_of(part.play):
                digest.update(content)
        trees = [Path(tree) for part in parts if is_play_file(tree := split_play(part.play)[1])]
        named = [word for part in parts for word in _words(part.params)]
        for path in trees:
            words = re.findall(r"[\w./\\-]+", path.read_text(errors="replace"))
            beside = partial(_beside, path.parent)
            named += [str(rename_models(word, beside)) for word in words]
        for model in sorted({found for word in named if (found := _model(word)) is not None}):
            digest.update(model.read_bytes())
        return digest.hexdigest()


def read_entrant(text: str, params: Mapping[str, object] | None = None, name: str | None = None) -> Entrant:
    """Return the entrant that a text names.

    Args:
        text: a play's name, a file of a play, a play of a Python file as in ``my_team.py:striker``, an
            entrant's file (YAML with the field ``entrant``), or a scenario's side as in ``six_v_six:blue``.
        params: parameters of the play; for plays only.
        name: name of the entrant; by default the text, or the name in its file.

    Raises:
        EntrantError: there is none, or its file is wrong.
        ScenarioError: the scenario of a side cannot be read.
    """
    given = dict(params or {})
    if split_play(text)[0] or text.endswith(".py"):
        if problem := problem_with_play(text):
            raise EntrantError(text, problem)
        return Entrant(name or text, text, (RobotPlay(play=text, params=given),))
    scenario, colon, side = text.rpartition(":")
    if colon and side in list(Team):
        if given:
            raise EntrantError(text, "a scenario's side takes no parameters; write an entrant's file")
        return _from_side(name or text, text, load_scenario(scenario), Team(side))
    if text.endswith((".yaml", ".yml")):
        data = read_yaml(Path(text), EntrantError)
        if _ENTRANT_FIELD in data:
            if given:
                raise EntrantError(text, "an entrant's file has its parameters inside")
            return _from_file(Path(text), data)
        if "robots" in data:
            raise EntrantError(text, f"is a scenario; name its side, as in {text}:blue")
    elif not is_play_file(text) and text not in PLAYS:
        raise EntrantError(text, _unknown(text))
    return Entrant(name or text, text, (RobotPlay(play=text, params=given),))


def meeting(scenario: Scenario, blue: Entrant, yellow: Entrant) -> Scenario:
    """Return the scenario with its sides played by two entrants; starts, limits and numbers stay.

    Raises:
        ScenarioError: what an entrant plays does not fit the scenario.
        EntrantError: a side has no robot.
    """
    met = scenario
    default = next((robot for robot in scenario.robots.blue if robot.goalkeeper), None)
    for team, entrant in ((Team.BLUE, blue), (Team.YELLOW, yellow)):
        robots = scenario.robots.of(team)
        if not robots:
            raise entrant.error(f"cannot play in {scenario.source}, where {team.value} has no robot")
        players = [robot.number for robot in robots if not robot.goalkeeper]
        for robot in robots:
            if not robot.goalkeeper:
                part = entrant.players[min(players.index(robot.number), len(entrant.players) - 1)]
            elif not players:
                part = entrant.goalkeeper or entrant.players[0]
            else:
                part = entrant.goalkeeper or _part(default or robot)
            name = f"{team.value} {robot.number}"
            met = met.with_robot(name, play=part.play, params=part.params, substitute={})
    return met


def _from_file(path: Path, data: dict[str, object]) -> Entrant:
    try:
        read = EntrantFile.model_validate(data)
    except ValidationError as error:
        field, problem = first_problem(error, EntrantFile, data)
        raise EntrantError(str(path), problem, field) from error
    imports = []
    for number, name in enumerate(read.imports):
        if not (path.parent / name).is_file():
            raise EntrantError(str(path), f"there is no file {path.parent / name}", f"imports.{number}")
        imports.append(str(path.parent / name))

    def beside(part: RobotPlay, field: str) -> RobotPlay:
        play = rename_play(part.play, lambda file: str(path.parent / file))
        if not split_play(play)[0]:
            play = join_play(imports, play)
        if problem := problem_with_play(play):
            raise EntrantError(str(path), problem, f"{field}.play")
        params = rename_models(part.params, lambda file: str(path.parent / file))
        return part.model_copy(update={"play": play, "params": params})

    players = tuple([beside(part, f"players.{number}") for number, part in enumerate(read.players)])
    goalkeeper = None if read.goalkeeper is None else beside(read.goalkeeper, "goalkeeper")
    if read.program is not None:
        still = RobotPlay(play="stand_still")
        return Entrant(read.entrant, str(path), (still,), still, read.program)
    return Entrant(read.entrant, str(path), players, goalkeeper)


def _from_side(name: str, text: str, scenario: Scenario, team: Team) -> Entrant:
    robots = scenario.robots.of(team)
    for robot in robots:
        if robot.limits is not None or robot.substitute:
            what = "limits" if robot.limits is not None else "substitute"
            raise EntrantError(text, f"{team.value} {robot.number} has {what}, which an entrant cannot bring")
    goalkeepers = [_part(robot) for robot in robots if robot.goalkeeper]
    players = [_part(robot) for robot in robots if not robot.goalkeeper]
    if not robots:
        raise EntrantError(text, f"{team.value} has no robot there")
    return Entrant(name, text, tuple(players or goalkeepers), goalkeepers[0] if goalkeepers else None)


def _beside(folder: Path, file: str) -> str:
    return str(folder / file)


def _words(value: object) -> Iterator[str]:
    """Yield the texts in plain data."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        for part in value.values():
            yield from _words(part)
    elif isinstance(value, Sequence):
        for part in value:
            yield from _words(part)


def _model(word: str) -> Path | None:
    """Return the model that a parameter names, if it does; shipped ones count as robobt's code."""
    try:
        path = find_model(word)
    except ModelError:
        return None
    return path if path.is_file() and path.resolve().parent != models_folder().resolve() else None


def _part(robot: RobotSetup) -> RobotPlay:
    return RobotPlay(play=robot.play, params=robot.params)


def _unknown(name: str) -> str:
    bundled = bundled_scenarios()
    meant = close_names(name, [*PLAYS, *bundled])
    there = "'robobt list plays' and 'robobt list scenarios' list what there is"
    return PLAYS.problem_with(name) or (
        f"no play is called {name!r}; an entrant is a play, a file (.yaml), or a scenario's side, as in "
        "six_v_six:blue, or a Python file's, as in my_team.py:striker. "
        + (f"Did you mean {' or '.join(meant)}?" if meant else there)
    )
