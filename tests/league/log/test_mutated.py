"""Logs with something changed in them: each is replayed or refused, in time and within bounds."""

from __future__ import annotations

import gzip
import logging
import random
import resource
import time
from pathlib import Path

import pytest

from robobt.config.errors import RobobtError
from robobt.league.log.files import LogKind, LogWriter, read_log
from robobt.league.log.world import record_log
from robobt.league.serve.server import SimServer
from robobt.league.serve.serving import served_line_up
from robobt.world.field import DIVISION_A
from tests.campaign import count
from tests.league.served import free_endpoints
from tests.mutation import mutated


@pytest.mark.slow
@pytest.mark.parametrize("ending", ["log", "log.gz"])
def test_mutated_logs_are_replayed_or_refused(ending: str, tmp_path: Path) -> None:
    logging.getLogger("robobt").setLevel(logging.CRITICAL)
    rng, replayed = random.Random(22), 0
    whole, path = tmp_path / "whole.log", tmp_path / f"game.{ending}"
    field = served_line_up(DIVISION_A, 2, "default")
    with LogWriter(whole) as log, SimServer(field, free_endpoints(), epoch=1.7e9, log=log) as server:
        for _ in range(20):
            server.step()
            server.send_due(field.time)
        log.write(round(1.7e18), LogKind.REFEREE, b"\x08\x01")
    original = whole.read_bytes()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for number in range(count(10_000)):
        data = mutated(original, rng)
        if ending == "log.gz":
            # Half of them damaged before they are packed, half after.
            data = gzip.compress(data, 1) if number % 2 else mutated(gzip.compress(original, 1), rng)
        path.write_bytes(data)
        begun = time.process_time()
        try:
            for _ in read_log(path):
                pass
            record_log(path, tmp_path / "out.robobt.arrows")
            replayed += 1
        except RobobtError as error:
            said = str(error)
            assert "\n" not in said
        assert time.process_time() - begun < 10.0
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 200_000
    print(f"{replayed} of {count(10_000)} were replayed")
