"""A recorded tick as a test case: what one robot's tree did then, and does it still do so.

Trees remember: places in sequences, timers, the last shot, who attacks. None of
that can be put back from outside, so a case holds the match from its start up to the
tick. It is played again with the recorded frames in place of a simulator: all trees of
the scenario are built anew, given the same seeds and ticked on every frame, the
referee's word included, and the robot's tree is compared at the last one. Nothing
random is left, so the outcome is always the same.

Recorded frames are rounded to the units of the file. A tree on the edge of a decision
may therefore do something else than in the match; that is found out when the case is
saved, and such a tick is refused.

Tree files are those of the day: a case names them from its own folder, and its trees are
built from what they hold when it is checked.

In a test::

    from robobt.match.regression_cases import check_case

    def test_the_striker_still_shoots() -> None:
        check_case("tests/cases/striker.yaml")
"""

from __future__ import annotations

import base64
import binascii
import json
import os
import zlib
from collections.abc import Iterator, Mapping
from copy import deepcopy
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError
from robobt.match.loop import Match
from robobt.match.recording import (
    Recording,
    RecordingError,
    load_recording,
    parse_recording,
    recording_lines,
)
from robobt.match.recording.outputs import value_text
from robobt.match.scenario.scenario import ScenarioError, rename_files, scenario_from
from robobt.tree.recording import node_paths
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.protocol import Placement, World
from robobt.world.state import Frame, RobotId

FORMAT = "robobt-case"
VERSION = 1
TOLERANCE = 1e-6
"""By how much a command may differ [m/s, rad/s]: what another processor's arithmetic may do."""

_MOST_BYTES = 2**27
_WORDS = {"S": "SUCCESS", "F": "FAILURE", "R": "RUNNING"}


class CaseError(RobobtError, ValueError):
    """A file is no test case, or a tick cannot be made one."""


class CaseFailedError(RobobtError, AssertionError):
    """The tree does something else now; the message says what."""


@dataclass(frozen=True)
class Case:
    """A test case.

    Attributes:
        path: the file.
        robot, tick: whose tree, and when.
        recording: the match up to the tick.
        statuses: by the ids of the nodes that had one then: SUCCESS, FAILURE, RUNNING.
        command: what the tree told its robot.
    """

    path: Path
    robot: RobotId
    tick: int
    recording: Recording
    statuses: Mapping[str, str]
    command: Mapping[str, Any]


@dataclass(frozen=True)
class _Played:
    """What the tree did at a tick."""

    statuses: dict[str, str]
    reasons: dict[str, str]
    command: dict[str, Any]


def save_case(recording: Recording | str | Path, robot: RobotId, tick: int, path: str | Path) -> Path:
    """Save a recorded tick as a test case, and return where it is.

    Args:
        recording: a recording or its file; the file is read again.
        tick: which one, from 0.

    Raises:
        RecordingError: the file is not a recording.
        CaseError: there is no such robot or tick, the tree was not ticked then, the recording
            does not say what was played, or played again the tree does not do what it did.
        OSError: the case cannot be written.
    """
    if not isinstance(recording, Recording):
        recording = load_recording(recording)
    path = Path(path)
    try:
        letters = recording.letters_at(robot, tick)
    except KeyError as error:
        raise CaseError(str(error.args[0])) from None
    if not 0 <= tick < len(recording):
        raise CaseError(f"{recording.path}: there is no tick {tick}; they are 0 to {len(recording) - 1}")
    if not letters.strip("sfr-"):
        raise CaseError(f"{recording.path}: the tree of {robot} was not ticked at tick {tick}")
    text = _text(recording, tick, path.parent)
    played = _play(parse_recording(text, recording.path), robot, tick, path.parent)
    nodes = recording.header.robots[recording.slot(robot)].tree
    recorded = {
        node.path: _WORDS[letter]
        for node, letter in zip(nodes, letters.upper(), strict=True)
        if letter != "-"
    }
    for node in nodes:
        was, now = recorded.get(node.path, "INVALID"), played.statuses.get(node.path, "INVALID")
        if was != now:
            raise CaseError(
                f"{recording.path}: played again on the rounded frames of the recording, {robot} does not do "
                f"at tick {tick} what it did: {node.path} was {was} and is {now}; take another tick"
            )
    seen = recording.observation(tick)
    data = {
        "format": FORMAT,
        "version": VERSION,
        "robot": str(robot),
        "tick": tick,
        "time": round(float(recording.times[tick]), 6),
        "expected": {"statuses": played.statuses, "command": played.command},
        "seen": {
            "ball": json.loads(value_text(seen.ball)),
            "robots": [
                {
                    "robot": str(RobotId(team, each.id)),
                    "x": round(each.x, 5),
                    "y": round(each.y, 5),
                    "heading": round(each.heading, 5),
                }
                for team, robots in ((Team.BLUE, seen.own), (Team.YELLOW, seen.opponents))
                for each in robots
            ],
            "store": recording.outputs_at(robot, tick),
        },
        "match": base64.b64encode(zlib.compress(text, 9)).decode("ascii"),
    }
    path.parent.mkdir(parents=True, exist_ok=True)
    # JSON is YAML; written so that no number or text changes its meaning.
    write_atomically(path, json.dumps(data, indent=2, allow_nan=False) + "\n")
    return path


def load_case(path: str | Path) -> Case:
    """Read a test case.

    Raises:
        CaseError: the file cannot be read or is none; the message names file and field.
    """
    path = Path(path)
    try:
        if path.stat().st_size > _MOST_BYTES:
            raise CaseError(f"{path}: is larger than {_MOST_BYTES >> 20} MiB")
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise CaseError(f"{path}: {error.strerror or error}") from None
    except (ValueError, RecursionError) as error:
        if isinstance(error, CaseError):
            raise
        raise CaseError(f"{path}: is not a robobt test case ({error})") from None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise CaseError(f"{path}: is not a robobt test case")
    if data.get("version") != VERSION:
        raise CaseError(f"{path}: version: {data.get('version')!r} cannot be read, only {VERSION}")
    robot, tick, expected = data.get("robot"), data.get("tick"), data.get("expected")
    try:
        team, number = str(robot).split()
        who = RobotId(Team(team), int(number))
    except ValueError:
        raise CaseError(f"{path}: robot: must be a team and a number, not {robot!r}") from None
    if not isinstance(expected, dict) or not all(
        isinstance(expected.get(key), dict) for key in ("statuses", "command")
    ):
        raise CaseError(f"{path}: expected: must have statuses and command")
    try:
        packed = base64.b64decode(str(data.get("match")), validate=True)
        text = zlib.decompressobj().decompress(packed, _MOST_BYTES)
        recording = parse_recording(text, path)
        recording.slot(who)
    except (binascii.Error, zlib.error, ValueError, RecordingError, KeyError) as error:
        raise CaseError(f"{path}: match: {error.args[0] if error.args else error}") from None
    if not isinstance(tick, int) or not 0 <= tick < len(recording):
        raise CaseError(f"{path}: tick: must be 0 to {len(recording) - 1}, not {tick!r}")
    return Case(path, who, tick, recording, expected["statuses"], expected["command"])


def check_case(case: Case | str | Path) -> None:
    """Play a case again and compare.

    Raises:
        CaseFailedError: the tree does something else; the message says which nodes and what else.
        CaseError: the file is no case, or its scenario cannot be played any more.
    """
    if not isinstance(case, Case):
        case = load_case(case)
    played = _play(case.recording, case.robot, case.tick, case.path.parent)
    problems = list(_differences(case, played))
    if problems:
        time = float(case.recording.times[case.tick])
        place = f"{case.path}: {case.robot} at tick {case.tick} ({time:.3f} s)"
        raise CaseFailedError(f"{place}: {'; '.join(problems)}")


def _differences(case: Case, played: _Played) -> Iterator[str]:
    for path in dict.fromkeys((*case.statuses, *played.statuses)):
        was, now = case.statuses.get(path, "not ticked"), played.statuses.get(path, "not ticked")
        if was != now:
            reason = f" ({played.reasons[path]})" if played.reasons.get(path) else ""
            yield f"{path} was {was} and is {now}{reason}"
    for key, told in case.command.items():
        tells = played.command.get(key)
        numbers = isinstance(told, float | int) and isinstance(tells, float | int)
        if told != tells and not (numbers and abs(told - tells) <= TOLERANCE):
            yield f"command {key} was {told!r} and is {tells!r}"


class _RecordedWorld(World):
    """A world that shows what was recorded, whatever anybody does."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording

    def reset(self, placement: Placement, seed: int) -> None:
        """Nothing to place."""

    def observe(self) -> Frame:
        """The first recorded frame, which all that is built before the match may look at."""
        return self._recording.observation(0)

    def truth(self) -> Frame:
        """The same."""
        return self._recording.frame(0)

    def act(self, commands: Mapping[RobotId, RobotCommand]) -> None:
        """Nothing moves."""

    def place_ball(self, x: float, y: float) -> None:
        """Nothing moves."""


def _play(recording: Recording, robot: RobotId, tick: int, folder: Path) -> _Played:
    """All trees on the recorded frames up to a tick, and what one of them did at that one.

    Args:
        folder: what the paths of files in the recording's scenario are relative to.
    """
    header = recording.header
    if not header.played:
        raise CaseError(f"{recording.path}: the recording does not say what was played")
    played = deepcopy(header.played)
    rename_files(played, lambda file: os.path.relpath(folder.resolve() / file))
    try:
        scenario = scenario_from(played, str(recording.path))
        match = Match(scenario, header.seed, lambda _: _RecordedWorld(recording))
    except ScenarioError as error:
        raise CaseError(str(error)) from error
    player = next((each for each in match.players if each.robot == robot), None)
    if player is None:
        raise CaseError(f"{recording.path}: {robot} is not in the scenario")
    commands: dict[RobotId, RobotCommand] = {}
    for now in range(tick + 1):
        commands = match.decide(recording.observation(now))
    nodes = player.runner.nodes
    depths = {id(nodes[0]): 0}
    for node in nodes:
        depths.update({id(child): depths[id(node)] + 1 for child in node.children})
    paths = node_paths([str(node.name) for node in nodes], [depths[id(node)] for node in nodes])
    statuses = {
        path: _WORDS[letter]
        for path, letter in zip(paths, player.runner.statuses(), strict=True)
        if letter != "-"
    }
    reasons = {path: node.feedback_message for path, node in zip(paths, nodes, strict=True)}
    command = asdict(commands.get(robot, RobotCommand()))
    return _Played(statuses, reasons, command | {"kick_trigger": str(command["kick_trigger"])})


def _text(recording: Recording, tick: int, folder: Path) -> bytes:
    """The lines of the recording up to the tick's one, the scenario's files as seen from a folder."""
    header, *rest = recording_lines(recording.path)
    data = json.loads(header)
    home = folder.resolve()
    rename_files(data.get("played"), lambda file: os.path.relpath(_found(recording, file), home))
    lines, ticks = [json.dumps(data, separators=(",", ":")).encode("utf-8")], 0
    for line in rest:
        lines.append(line)
        if b'"x":' in line:
            ticks += json.loads(line)["n"]
        if ticks > tick:
            break
    return b"\n".join(lines) + b"\n"


def _found(recording: Recording, file: str) -> Path:
    """A file of the scenario, seen from here, where the match may have been played, or from the recording."""
    for folder in (Path(), recording.path.parent):
        if (folder / file).is_file():
            return (folder / file).resolve()
    raise CaseError(f"{recording.path}: {file}, which was played, is neither here nor beside the recording")
