"""A recording's tracking as a Parquet table, which data tools open."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from robobt.config.atomic import replacing
from robobt.config.errors import naming
from robobt.match.recording.recording import Recording
from robobt.world.game import OPEN_PLAY, GameState

_BALL_COLUMNS = ("x", "y", "vx", "vy", "z", "vz")
_ROBOT_COLUMNS = ("x", "y", "heading", "vx", "vy", "omega")


def write_parquet(recording: Recording, path: str | Path) -> Path:
    """Write where ball and robots truly were, one row a tick, and return where the file is.

    Columns: ``time`` [s]; ``ball_x``, ``ball_y`` [m], ``ball_vx``, ``ball_vy`` [m/s], ``ball_z`` [m],
    ``ball_vz`` [m/s]; for each robot, as ``blue_3_x``: x, y [m], heading [rad], vx, vy [m/s], omega [rad/s]
    and contact (whether it has the ball in its mouth), null while it is off the field; ``command``,
    ``blue_score``, ``yellow_score``. World coordinates: blue defends -x. The file's metadata hold the
    recording's header under ``robobt``.

    Args:
        recording: what to write.
        path: the file; it takes its place once it is whole.

    Raises:
        OSError: the file cannot be written.
    """
    path = Path(path)
    columns: dict[str, object] = {"time": recording.times}
    columns |= {f"ball_{name}": recording.truth.ball[:, i] for i, name in enumerate(_BALL_COLUMNS)}
    for slot, robot in enumerate(recording.header.robots):
        owner = f"{robot.team.value}_{robot.number}"
        rows = recording.truth.robots[:, slot]
        columns |= {f"{owner}_{name}": rows[:, i] for i, name in enumerate(_ROBOT_COLUMNS)}
        columns[f"{owner}_contact"] = recording.truth.contact[:, slot]
    games = _games(recording)
    columns["command"] = [game.command.name for game in games]
    columns["blue_score"] = np.array([game.blue_score for game in games], dtype=np.int32)
    columns["yellow_score"] = np.array([game.yellow_score for game in games], dtype=np.int32)
    table = pa.table({name: pa.array(values, from_pandas=True) for name, values in columns.items()})
    about = recording.header.model_dump_json(exclude={"robots": {"__all__": {"tree"}}})
    table = table.replace_schema_metadata({"robobt": about})
    with replacing(path) as temporary, naming(path):
        pq.write_table(table, temporary, compression="zstd")
    return path


def _games(recording: Recording) -> list[GameState]:
    changes = dict(recording.games)
    game, games = OPEN_PLAY, []
    for tick in range(len(recording)):
        game = changes.get(tick, game)
        games.append(game)
    return games
