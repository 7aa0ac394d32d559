"""A recorded tick as a regression case: it checks that one robot's tree still does the same.

Trees have state: places in sequences, timers, the last shot. It cannot be restored from outside, so a case
holds the match up to the tick. All trees of the scenario are built again from the current files and skills,
with the same seeds, and ticked on every recorded frame; the robot's tree is compared at the last frame.
Nothing random is left.

Recorded frames are rounded. A tree close to a threshold may decide differently on them than in the match;
such a tick is refused when the case is saved.

In a test::

    from robobt.match.regression_cases import check_regression_case

    def test_the_striker_still_shoots() -> None:
        check_regression_case("tests/cases/striker.yaml")
"""

from __future__ import annotations

import base64
import os
import zlib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, JsonValue, ValidationError

from robobt import __version__
from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError, message_of
from robobt.config.validation import first_problem
from robobt.match.loop import MatchLoop
from robobt.match.recording import Recording, RecordingError
from robobt.match.recording.reader import parse_recording
from robobt.match.recording.stores import plain
from robobt.match.recording.stream import MOST_RECORDING_BYTES, new_stream, open_stream, read_bytes
from robobt.match.scenario.scenario import ScenarioError, rename_files, scenario_from
from robobt.tree.recording import node_ids
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.protocol import Placement, World
from robobt.world.state import Frame, RobotId

COMMAND_TOLERANCE = 1e-6
"""Tolerance of a command's numbers [m/s, rad/s], for differences in arithmetic between processors."""

_STATUS_NAMES = {"S": "SUCCESS", "F": "FAILURE", "R": "RUNNING"}


class RegressionCaseError(RobobtError, ValueError):
    """A file is no regression case, or a tick cannot be saved as one."""


class RegressionError(RobobtError, AssertionError):
    """The tree now decides differently; the message says how."""


class _CaseFile(BaseModel):
    model_config = ConfigDict(extra="forbid")

    format: Literal["robobt-regression-case"] = "robobt-regression-case"
    version: Literal[1] = 1
    robot: str = Field(pattern=r"^(blue|yellow) \d{1,4}$")
    tick: int = Field(ge=0)
    time: float = Field(description="[s]")
    statuses: dict[str, str] = Field(description="statuses, by the ids of the nodes that had one")
    command: dict[str, bool | float | str] = Field(description="the tree's command")
    seen: JsonValue = Field(None, description="the tree's view, for human readers")
    match: str = Field(description="the recording up to the tick, packed by zlib, in base64")


@dataclass(frozen=True)
class TreeDecision:
    """A tree's result at a tick.

    Attributes:
        statuses: SUCCESS, FAILURE or RUNNING, by the ids of the nodes that had a status.
        command: the tree's command, by field.
        reasons: feedback of all nodes, by id.
    """

    statuses: Mapping[str, str]
    command: Mapping[str, bool | float | str]
    reasons: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class RegressionCase:
    """A robot's tree at the last tick of the first part of a recorded match."""

    path: Path
    robot: RobotId
    tick: int
    recording: Recording
    expected: TreeDecision


def save_regression_case(recording: Recording, robot: RobotId, tick: int, path: str | Path) -> Path:
    """Save a recorded robot's tick (from 0) as a regression case at ``path``, and return the path.

    Raises:
        RegressionCaseError: there is no such robot or tick, the tree was not ticked then, the
            recording does not hold its scenario, or the tree decides differently when played again.
        OSError: the case cannot be written.
    """
    path = Path(path)
    try:
        letters = recording.letters_at(robot, tick)
    except KeyError as error:
        raise RegressionCaseError(str(error.args[0])) from None
    if not 0 <= tick < len(recording):
        raise RegressionCaseError(
            f"{recording.path}: there is no tick {tick}; they are 0 to {len(recording) - 1}"
        )
    if not letters.strip("sfr-"):
        raise RegressionCaseError(f"{recording.path}: the tree of {robot} was not ticked at tick {tick}")
    match = _beginning(recording, tick, path.parent)
    played = _play(parse_recording(match, recording.path), robot, tick, path.parent)
    for node, letter in zip(recording.nodes(robot), letters.upper(), strict=True):
        was, now = _STATUS_NAMES.get(letter, "INVALID"), played.statuses.get(node.path, "INVALID")
        if was != now:
            raise RegressionCaseError(
                f"{recording.path}: played again on the rounded frames of the recording, {robot} does not do "
                f"at tick {tick} what it did: {node.path} was {was} and is {now}; take another tick"
            )
    frame = recording.observation(tick)
    seen = {
        "ball": frame.ball,
        "robots": {
            str(RobotId(team, each.id)): {"x": each.x, "y": each.y, "heading": each.heading}
            for team, robots in ((Team.BLUE, frame.own), (Team.YELLOW, frame.opponents))
            for each in robots
        },
        "store": recording.written_at(robot, tick),
    }
    file = _CaseFile(
        robot=str(robot),
        tick=tick,
        time=round(float(recording.times[tick]), 6),
        statuses=played.statuses,
        command=played.command,
        seen=plain(seen),
        match=base64.b64encode(zlib.compress(match, 9)).decode("ascii"),
    )
    path.parent.mkdir(parents=True, exist_ok=True)
    # JSON is valid YAML, and keeps every number and text exact.
    write_atomically(path, file.model_dump_json(indent=2) + "\n")
    return path


def load_regression_case(path: str | Path) -> RegressionCase:
    """Read a regression case.

    Raises:
        RegressionCaseError: the file cannot be read or is no regression case; the message names file and
        field.
    """
    path = Path(path)
    try:
        file = _CaseFile.model_validate_json(read_bytes(path))
        match = zlib.decompressobj().decompress(
            base64.b64decode(file.match, validate=True), MOST_RECORDING_BYTES
        )
        recording = parse_recording(match, path)
        team, number = file.robot.split()
        robot = RobotId(Team(team), int(number))
        recording.slot(robot)
    except ValidationError as error:
        problem = ": ".join(filter(None, first_problem(error, _CaseFile)))
        raise RegressionCaseError(
            f"{path}: is not a regression case of robobt {__version__} ({problem}); "
            "save the tick again with 'robobt record case'"
        ) from None
    except RecordingError as error:
        raise RegressionCaseError(str(error)) from None
    except (zlib.error, ValueError, KeyError) as error:
        raise RegressionCaseError(f"{path}: match: {message_of(error)}") from None
    if file.tick >= len(recording):
        raise RegressionCaseError(f"{path}: tick: must be 0 to {len(recording) - 1}, not {file.tick}")
    return RegressionCase(path, robot, file.tick, recording, TreeDecision(file.statuses, file.command))


def check_regression_case(case: RegressionCase | str | Path) -> None:
    """Play a case again and compare.

    Raises:
        RegressionError: the tree decides differently; the message names the nodes and the differences.
        RegressionCaseError: the file is no case, or its scenario can no longer be played.
    """
    if not isinstance(case, RegressionCase):
        case = load_regression_case(case)
    played = _play(case.recording, case.robot, case.tick, case.path.parent)
    problems = list(_differences(case.expected, played))
    if problems:
        time = float(case.recording.times[case.tick])
        place = f"{case.path}: {case.robot} at tick {case.tick} ({time:.3f} s)"
        raise RegressionError(f"{place}: {'; '.join(problems)}")


def _differences(expected: TreeDecision, actual: TreeDecision) -> Iterator[str]:
    for path in dict.fromkeys((*expected.statuses, *actual.statuses)):
        statuses = [each.statuses.get(path, "not ticked") for each in (expected, actual)]
        if statuses[0] != statuses[1]:
            reason = f" ({actual.reasons[path]})" if actual.reasons.get(path) else ""
            yield f"{path} was {statuses[0]} and is {statuses[1]}{reason}"
    for key, was in expected.command.items():
        now = actual.command.get(key)
        near = isinstance(was, float) and isinstance(now, float) and abs(was - now) <= COMMAND_TOLERANCE
        if was != now and not near:
            yield f"command {key} was {was!r} and is {now!r}"


class _RecordedWorld(World):
    """A world that replays a recording, whatever the commands."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording

    def reset(self, placement: Placement, seed: int) -> None:
        """Place nothing."""

    def observe(self) -> Frame:
        """Return the first recorded frame, for everything built before the match."""
        return self._recording.observation(0)

    def truth(self) -> Frame:
        """Return the first recorded frame."""
        return self._recording.frame(0)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Move nothing."""

    def place_ball(self, x: float, y: float) -> None:
        """Move nothing."""


def _play(recording: Recording, robot: RobotId, tick: int, folder: Path) -> TreeDecision:
    """Tick all trees on the recorded frames up to a tick, and return the result of one of them.

    File names in the recording are relative to ``folder``.
    """
    header = recording.header
    if not header.played:
        raise RegressionCaseError(f"{recording.path}: the recording does not hold its scenario")
    scenario_data = deepcopy(header.played)
    rename_files(scenario_data, lambda file: os.path.relpath(folder.resolve() / file))
    try:
        scenario = scenario_from(scenario_data, str(recording.path))
        match = MatchLoop(scenario, header.seed, lambda _: _RecordedWorld(recording))
    except ScenarioError as error:
        raise RegressionCaseError(str(error)) from error
    player = next((each for each in match.players if each.robot == robot), None)
    if player is None:
        raise RegressionCaseError(f"{recording.path}: {robot} is not in the scenario")
    commands: dict[RobotId, RobotCommand] = {}
    with match:
        for now in range(tick + 1):
            commands = match.decide(recording.observation(now))
    nodes = player.runner.nodes
    paths = [path for _, path in node_ids(nodes)]
    letters = zip(paths, player.runner.statuses(), strict=True)
    statuses = {path: _STATUS_NAMES[letter] for path, letter in letters if letter != "-"}
    reasons = {path: node.feedback_message for path, node in zip(paths, nodes, strict=True)}
    sent = commands.get(robot, RobotCommand())
    command = {
        **{name: float(getattr(sent, name)) for name in ("vx", "vy", "omega", "kick_speed")},
        **({"kick_angle": float(sent.kick_angle)} if sent.kick_angle else {}),
        "kick_trigger": sent.kick_trigger.value,
        "dribbler": bool(sent.dribbler),
    }
    return TreeDecision(statuses, command, reasons)


def _beginning(recording: Recording, tick: int, folder: Path) -> bytes:
    """Return the recording up to a tick, with the scenario's files relative to a folder."""
    header, batches = open_stream(read_bytes(recording.path), recording.path)
    home = folder.resolve()
    rename_files(header.played, lambda file: os.path.relpath(_found(recording, file), home))
    left, sink = tick + 1, BytesIO()
    with new_stream(sink, header) as writer:
        for batch in batches:
            writer.write_batch(batch.slice(0, left))
            left -= len(batch)
            if left <= 0:
                break
    return sink.getvalue()


def _found(recording: Recording, file: str) -> Path:
    """Find a file of the scenario in the working folder or beside the recording."""
    for folder in (Path(), recording.path.parent):
        if (folder / file).is_file():
            return (folder / file).resolve()
    raise RegressionCaseError(f"{recording.path}: {file} is neither here nor beside the recording")
