"""A recording as a Parquet table."""

from __future__ import annotations

import json
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from robobt.match.recording import load_recording
from robobt.match.recording.parquet import write_parquet
from robobt.worlds import play_match

pytestmark = pytest.mark.integration


def test_a_table_holds_where_ball_and_robots_were_at_every_tick(tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    play_match("striker_vs_goalkeeper", 3, record=path)
    recording = load_recording(path)
    table = pq.read_table(write_parquet(recording, tmp_path / "match.parquet"))
    assert table.num_rows == len(recording)
    rows = table.to_pylist()
    for tick in (0, len(recording) // 2, len(recording) - 1):
        frame, row = recording.frame(tick), rows[tick]
        assert (row["time"], row["ball_x"], row["ball_vy"]) == (frame.time, frame.ball.x, frame.ball.vy)
        blue = frame.own[0]
        assert (row[f"blue_{blue.id}_x"], row[f"blue_{blue.id}_heading"]) == (blue.x, blue.heading)
        assert (row["command"], row["blue_score"]) == (frame.game.command.name, frame.game.blue_score)
    assert json.loads(table.schema.metadata[b"robobt"])["seed"] == recording.header.seed
