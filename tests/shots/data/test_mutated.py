"""Files of shots with something changed in them: each is read or refused, in time and within bounds."""

from __future__ import annotations

import random
import resource
import time
from pathlib import Path

import pyarrow as pa
import pytest

from robobt.shots.data.files import read_shots, write_shots
from robobt.shots.data.problems import ShotDataError
from robobt.shots.data.schema import SCHEMA
from tests.campaign import count
from tests.mutation import mutated
from tests.shots.data.test_files import AUTHOR, _row


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["parquet", "csv", "author.csv"])
def test_mutated_shots_are_read_or_refused(ending: str, tmp_path: Path) -> None:
    rng, read = random.Random(21), 0
    path = tmp_path / f"shots.{ending}"
    if ending == "author.csv":
        path.write_text(AUTHOR)
    else:
        write_shots(pa.Table.from_pylist([_row(seed=seed) for seed in range(20)], schema=SCHEMA), path)
    original = path.read_bytes()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(count(10_000)):
        path.write_bytes(mutated(original, rng))
        begun = time.process_time()
        try:
            read += read_shots(path).num_rows > 0
        except ShotDataError as error:
            said = str(error)
            assert said.startswith(str(path))
            assert "\n" not in said
        assert time.process_time() - begun < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    print(f"{read} of {count(10_000)} were read")
