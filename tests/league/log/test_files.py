"""The league's logs: every frame comes back, and a spoilt log is one plain error."""

from __future__ import annotations

import gzip
import logging
import random
import resource
import struct
import time
import tracemalloc
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.config.errors import RobobtError
from robobt.league.log.files import LogError, LogKind, LogRecord, LogWriter, read_log
from robobt.league.log.names import is_log
from robobt.league.log.world import LogWorld, record_log
from robobt.league.serve.served_field import served_line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import Referee
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import read_vision
from robobt.match import MatchLoop, load_scenario
from robobt.match.recording import load_recording
from robobt.match.recording.statistics import recorded_statistics
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.world import World
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_A
from robobt.world.game import GameState, RefereeCommand, Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId
from robobt.worlds import world_from
from tests.campaign import count
from tests.league.served import free_endpoints
from tests.mutation import mutated

RECORDS = [
    LogRecord(1_700_000_000_000_000_001, LogKind.VISION, b"a frame"),
    LogRecord(1_700_000_000_016_666_667, LogKind.REFEREE, b""),
    LogRecord(1_700_000_000_033_333_334, 99, bytes(range(256))),
]


def write(path: Path, records: list[LogRecord] = RECORDS) -> Path:
    with LogWriter(path) as log:
        for time, kind, data in records:
            log.write(time, kind, data)  # type: ignore[arg-type]
    return path


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two seconds of a served field on which two robots drive, with the referee's words."""
    path = tmp_path_factory.mktemp("logs") / "game.log.gz"
    field = served_line_up(DIVISION_A, 2, "default")
    publisher = RefereePublisher()
    with LogWriter(path) as log, SimServer(field, free_endpoints(), epoch=1.7e9, log=log) as server:
        for i in range(120):
            field.command(RobotId(Team.BLUE, 0), RobotCommand(0.5))
            server.step()
            server.send_due(field.time)
            command = RefereeCommand.STOP if i < 60 else RefereeCommand.FORCE_START
            time = 1.7e9 + field.time
            log.write(round(time * 1e9), LogKind.REFEREE, publisher.write(GameState(command), time))
    return path


@given(
    st.lists(st.tuples(st.integers(-(2**63), 2**63 - 1), st.sampled_from(LogKind), st.binary(max_size=300)))
)
def test_any_records_come_back(
    tmp_path_factory: pytest.TempPathFactory, records: list[tuple[int, LogKind, bytes]]
) -> None:
    folder = tmp_path_factory.mktemp("any")
    expected = [LogRecord(*record) for record in records]
    for name in ("any.log", "any.log.gz"):
        assert list(read_log(write(folder / name, expected))) == expected


def test_the_bytes_are_those_of_the_format(tmp_path: Path) -> None:
    data = write(tmp_path / "game.log", RECORDS[:1]).read_bytes()
    assert data == b"SSL_LOG_FILE" + struct.pack(">iqii", 1, RECORDS[0].time, 4, 7) + b"a frame"


def test_every_frame_of_a_served_field_comes_back(played: Path) -> None:
    frames = [read_vision(record.data, PacketCounts()) for record in read_log(played) if record.kind == 4]
    assert len(frames) == 120
    for number, packet in enumerate(frames, start=1):
        assert packet is not None
        assert packet.frame is not None
        assert packet.frame.number == number
        assert len(packet.frame.robots) == 4
        assert packet.frame.captured == pytest.approx(number / 60)


@pytest.mark.parametrize("name", ["game.log", "game.log.gz"])
@pytest.mark.parametrize("cut", [1, 100, 270])
def test_a_log_that_is_cut_off_ends_with_its_last_whole_record(
    tmp_path: Path, name: str, cut: int, caplog: pytest.LogCaptureFixture
) -> None:
    path = write(tmp_path / name)
    if name.endswith(".gz"):
        whole = gzip.decompress(path.read_bytes())
        # As a killed writer leaves it: the compressed stream has no end.
        path.write_bytes(gzip.compress(whole[:-cut])[:-8])
    else:
        path.write_bytes(path.read_bytes()[:-cut])
    with caplog.at_level(logging.WARNING, logger="robobt"):
        assert list(read_log(path)) == RECORDS[:2]
    assert "ends in the middle of record 2" in caplog.text


@pytest.mark.parametrize("data", [b"", b"SSL_LOG", b"something else entirely"])
def test_what_is_no_log_is_one_plain_error(tmp_path: Path, data: bytes) -> None:
    for path in (tmp_path / "game.log", tmp_path / "game.log.gz"):
        path.write_bytes(data)
        with pytest.raises(LogError, match=f"^{path}: is not a log: "):
            list(read_log(path))


def test_another_version_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "game.log"
    path.write_bytes(b"SSL_LOG_FILE" + struct.pack(">i", 2))
    with pytest.raises(LogError, match="has version 2 of the format; only 1 can be read"):
        list(read_log(path))


@pytest.mark.parametrize("name", ["game.log", "game.log.gz"])
@pytest.mark.parametrize("kind", [LogKind.INDEX, 99])
def test_records_without_a_packet_are_skipped_whatever_their_size(
    tmp_path: Path, name: str, kind: int
) -> None:
    index = LogRecord(0, kind, bytes(8 * 200_000))
    path = write(tmp_path / name, [RECORDS[0], index, *RECORDS[1:], index])
    assert list(read_log(path)) == RECORDS


def test_a_record_that_is_skipped_takes_no_memory_and_may_be_cut_off(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    path = write(tmp_path / "game.log")
    path.write_bytes(path.read_bytes() + struct.pack(">qii", 0, LogKind.INDEX, 2**31 - 1) + bytes(100))
    tracemalloc.start()
    assert list(read_log(path)) == RECORDS
    assert tracemalloc.get_traced_memory()[1] < 4 << 20
    tracemalloc.stop()
    assert "ends in the middle of record 3" in caplog.text


@pytest.mark.parametrize("size", [(1 << 20) + 1, -1])
def test_a_packet_of_an_impossible_size_is_refused_without_reading_it(tmp_path: Path, size: int) -> None:
    path = write(tmp_path / "game.log")
    path.write_bytes(path.read_bytes() + struct.pack(">qii", 0, LogKind.VISION, size))
    records = read_log(path)
    assert [next(records) for _ in RECORDS] == RECORDS
    with pytest.raises(LogError, match=f"record 3: impossible size of {size} bytes"):
        next(records)


def test_a_log_is_a_world_that_only_observes(played: Path) -> None:
    world = LogWorld(played)
    assert isinstance(world, World)
    world.reset(Placement(), 0)
    frame = world.observe()
    assert frame.field == DIVISION_A
    assert [robot.id for robot in frame.own] == [0, 1]
    start = frame.own[0].x
    world.act({})
    assert world.observe().game.stopped
    for _ in range(89):
        world.act({RobotId(Team.BLUE, 1): RobotCommand(3.0)})
    frame = world.observe()
    assert frame.time == pytest.approx(1.5)
    assert frame.own[0].vx == pytest.approx(0.5, abs=0.02)
    assert frame.own[0].x == pytest.approx(start + 0.5 * 1.5, abs=0.1)
    assert frame.own[1].speed < 0.01
    assert frame.game.in_play
    assert not world.ended
    for _ in range(40):
        world.act({})
    assert world.ended


def test_a_world_of_a_log_can_be_played_again(played: Path) -> None:
    world = LogWorld(played)
    looks = []
    for _ in range(2):
        world.reset(Placement(), 0)
        for _ in range(30):
            world.act({})
        looks.append(world.observe())
    assert looks[0] == looks[1]


def test_a_log_of_tracked_frames_alone_is_a_world_too(tmp_path: Path, played: Path) -> None:
    world = LogWorld(played)
    world.reset(Placement(), 0)
    seen = world.observe()
    data = write_tracked(seen, 1, 0.0, "id")
    path = write(
        tmp_path / "tracked.log", [LogRecord(i * 16_666_667, LogKind.TRACKER, data) for i in range(10)]
    )
    tracked = LogWorld(path)
    tracked.reset(Placement(), 0)
    assert [robot.id for robot in tracked.observe().own] == [0, 1]
    assert tracked.observe().own[0].x == pytest.approx(seen.own[0].x, abs=1e-6)


def test_junk_in_a_log_is_passed_over_and_counted(tmp_path: Path, played: Path) -> None:
    records = list(read_log(played))
    junk = [record._replace(data=b"\xff\xff") for record in records[:20]]
    world = LogWorld(write(tmp_path / "junk.log", [*junk, *records[20:]]))
    world.reset(Placement(), 0)
    for _ in range(10):
        world.act({})
    assert len(world.observe().own) == 2
    assert world.counts.unreadable > 0


def test_a_long_pause_is_shortened(tmp_path: Path, played: Path) -> None:
    records = list(read_log(played))
    hour = 3_600_000_000_000
    late = [record._replace(time=record.time + hour) for record in records[100:]]
    world = LogWorld(write(tmp_path / "paused.log", records[:100] + late))
    world.reset(Placement(), 0)
    for _ in range(400):
        world.act({})
    assert world.ended


def test_a_log_without_robots_is_one_plain_error(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="holds no robot"):
        LogWorld(write(tmp_path / "empty.log", [])).reset(Placement(), 0)


def test_a_log_becomes_a_recording(tmp_path: Path, played: Path) -> None:
    recording = load_recording(record_log(played, tmp_path / "game.robobt.arrows"))
    assert recording.header.field == DIVISION_A
    assert [str(robot.id) for robot in recording.header.robots] == [
        "blue 0",
        "blue 1",
        "yellow 0",
        "yellow 1",
    ]


def test_a_logs_game_events_are_recorded_once_and_counted(tmp_path: Path, played: Path) -> None:
    crash = RefereeEvent(0.5, EventKind.BOT_CRASH_UNIQUE, Team.YELLOW, RobotId(Team.YELLOW, 1))
    records = list(read_log(played))
    for i, record in enumerate(records):
        if record.kind == LogKind.REFEREE and i > len(records) // 2:
            message = Referee.FromString(record.data)
            message.game_events.append(write_event(crash, 0.0, "test"))
            records[i] = record._replace(data=message.SerializeToString())
    told = write(tmp_path / "told.log", records)
    recording = load_recording(record_log(told, tmp_path / "told.robobt.arrows"))
    assert [(event.kind, event.team) for event in recording.events] == [("bot_crash_unique", Team.YELLOW)]
    assert recorded_statistics(recording)["yellow"].fouls == 1


def test_a_scenarios_robots_watch_a_log(played: Path) -> None:
    factory = world_from(str(played))
    match = MatchLoop(load_scenario("striker_vs_goalkeeper").lasting(1.0), 0, factory)
    assert isinstance(match.world, LogWorld)
    result = match.play()
    assert result.ticks == 41
    assert match.game.command is RefereeCommand.STOP or match.game.in_play


@pytest.mark.parametrize(
    ("name", "expected"), [("a.log", True), ("a.LOG.gz", True), ("a.gz", False), ("a.yaml", False)]
)
def test_logs_are_known_by_their_names(name: str, expected: bool) -> None:
    assert is_log(name) is expected


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
