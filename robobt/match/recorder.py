"""The recorder of a match: what its recording says of the scenario and of the robots."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from robobt.match.players import Player
from robobt.match.recording import RecordedRobot, Recorder, RecordingHeader
from robobt.match.scenario.scenario import Scenario
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits
from robobt.world.state import Frame, RobotId


def match_recorder(
    path: Path, scenario: Scenario, trial: int, seed: int, first: Frame, players: Sequence[Player]
) -> Recorder:
    """Open the recording of a match; ``first`` is its first true frame.

    Raises:
        OSError: the file cannot be written.
    """
    header = RecordingHeader(
        scenario=scenario.name,
        trial=trial,
        seed=seed,
        period=scenario.period,
        field=first.field,
        played=scenario.model_dump(mode="json"),
        robots=tuple(
            RecordedRobot(
                team=robot.team, number=robot.number, play=setup.play, limits=_limits_of(robot, first)
            )
            for robot, setup in scenario.robots
        ),
    )
    return Recorder(
        path,
        header,
        {player.robot: player.runner for player in players},
        {player.robot: player.store for player in players},
    )


def _limits_of(robot: RobotId, frame: Frame) -> RobotLimits:
    state = frame.seen_by(robot.team).robot(robot.number)
    return DEFAULT_LIMITS if state is None else state.limits
