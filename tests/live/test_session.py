"""The pace at which a match is shown, and whose wishes it follows."""

import base64
import threading
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import numpy as np
import pytest

from benchmarks.live import bench_live
from robobt.live.messages import Act, Pause, Seek, Speed
from robobt.live.replayed import RecordingPlayback
from robobt.live.server import Server
from robobt.live.session import Live
from robobt.match import MatchLoop, load_scenario, run_trials_in
from robobt.match.recording import load_recording
from robobt.match.recording.reader import parse_recording
from robobt.match.scenario.scenario import Scenario
from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.skills.aim.raters.shot_predictor import shot_predictor
from robobt.world.features import SHOT_SCENE
from robobt.world.protocol import WrappedWorld
from robobt.worlds import sim_world
from tests.live.playing import Client, playing
from tests.waiting import soon

pytestmark = pytest.mark.integration


class Clock:
    """Time that passes while somebody sleeps, and a little at each look."""

    def __init__(self) -> None:
        self.now = self.slept = 0.0

    def __call__(self) -> float:
        self.now += 1e-5
        return self.now

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        self.slept += seconds


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("striker_vs_goalkeeper").lasting(2.0)


@pytest.fixture
def server() -> Iterator[Server]:
    with Server() as server:
        yield server


def act(server: Server, act: Act) -> None:
    server.inbox.put((act, perf_counter()))


@pytest.mark.parametrize("speed", [0.5, 1.0, 4.0])
def test_a_match_takes_as_long_as_its_speed_says(server: Server, scenario: Scenario, speed: float) -> None:
    clock = Clock()
    live = Live(server, speed, clock=clock, sleep=clock.sleep)
    with MatchLoop(scenario, 3, sim_world) as match:
        assert live.play(match)
    assert clock.now == pytest.approx(match.result().time / speed, rel=0.02)
    assert live.late == 0


def test_what_is_shown_is_what_would_be_played_unseen(
    server: Server, scenario: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.live.session.LOOK", 0.1)
    record = {1: tmp_path / "m.robobt.arrows"}
    run = run_trials_in(scenario, sim_world, 2, seed=5, play=Live(server, 20.0).conduct, record=record)
    usual = run_trials_in(scenario, sim_world, 2, seed=5)
    assert [result.trace for result in run.results] == [result.trace for result in usual.results]
    assert record[1].stat().st_size > 1000


def test_models_are_loaded_before_a_match_goes_on(server: Server) -> None:
    shot_predictor.cache_clear()
    with MatchLoop(load_scenario("three_v_three"), 3, sim_world) as match:
        Live(server).begin(match)
    before = shot_predictor.cache_info().misses
    shot_predictor(ExpectedGoal().model, SHOT_SCENE)
    assert shot_predictor.cache_info().misses == before


def test_a_field_waits_for_nobody(server: Server, scenario: Scenario) -> None:
    class Field(WrappedWorld):
        @property
        def paced(self) -> bool:
            return True

    clock = Clock()
    live = Live(server, clock=clock, sleep=clock.sleep)
    act(server, Pause(do="pause", on=True))
    act(server, Speed(do="speed", factor=0.1))
    with MatchLoop(scenario, 3, lambda scenario: Field(sim_world(scenario))) as match:
        assert live.play(match)
    assert clock.slept == 0.0
    assert "waits for nobody" in server.audience.state["said"][1]
    assert match.result().trace == MatchLoop(scenario, 3, sim_world).play().trace


def test_each_robots_delay_is_sent_where_it_is_measured(server: Server, scenario: Scenario) -> None:
    clock = Clock()
    live = Live(server, clock=clock, sleep=clock.sleep)
    live.play(MatchLoop(scenario, 3, sim_world))
    assert server.audience.state["delays"] is None
    measured = scenario.model_copy(update={"predict": "measured"}).lasting(4.0)
    live.play(MatchLoop(measured, 3, sim_world))
    delays = server.audience.state["delays"]
    assert set(delays) == {"blue 0", "yellow 0"}
    seconds, half = delays["blue 0"]
    assert abs(seconds) < 0.005
    assert 0.0 < half < 0.02


def test_a_match_that_waits_shows_its_start_and_what_is_moved() -> None:
    with playing("striker_vs_goalkeeper", paused=True) as session, Client(session.server.url) as client:
        client.read(lambda it: it.chunks)
        ball = session.match.world.truth().ball
        assert ball_of(client) == pytest.approx(ball.position, abs=0.001)
        client.ask(do="ball", x=-1.25, y=0.5, held=True)
        client.read(lambda it: ball_of(it) == pytest.approx((-1.25, 0.5), abs=0.001))
        assert [chunk["frames"] for chunk in client.chunks] == [1, 1]
        # What is shown between ticks is none, and the next tick takes its place.
        stream = session.server.audience.stream
        assert stream is not None
        assert stream.end == 0
        client.ask(do="ball", x=-1.25, y=0.5)
        client.ask(do="step")
        client.read(lambda it: len(it.chunks) > 2 and session.ticks == 1 and stream.end == 1)
        saved = parse_recording(stream.recording(), Path("live"))
        assert saved.times.tolist() == [0.0]
        assert saved.truth.ball[0, :2] == pytest.approx((-1.25, 0.5), abs=0.001)


def test_what_is_moved_in_a_pause_moves_nothing_else() -> None:
    with playing("striker_vs_goalkeeper", paused=True) as session, Client(session.server.url) as client:
        client.ask(do="step", ticks=30)
        stream = soon(lambda: session.server.audience.stream)
        assert stream is not None
        end = 29 * session.match.scenario.period
        client.read(lambda it: it.chunks and numbers(it.chunks[-1]["times"], "<f4")[-1] > end - 1e-3)
        shown = places_of(client)
        # The last tick has led the robots on, which the next one will show.
        assert shown != true_places(session.match)
        client.ask(do="ball", x=-1.25, y=0.5)
        client.read(lambda it: ball_of(it) == pytest.approx((-1.25, 0.5), abs=0.001))
        assert places_of(client) == shown
        client.ask(do="robot", robot="blue 0", x=1.0, y=-1.0, heading=0.0)
        client.read(lambda it: places_of(it) == [[1000, -1000], shown[1]])


def test_a_message_that_is_none_is_answered() -> None:
    with playing("striker_vs_goalkeeper", paused=True) as session, Client(session.server.url) as client:
        client.read(lambda it: it.state.get("steers"))
        client.ask(do="dance")
        client.read(lambda it: it.refused)
        assert "is one of: pause, step" in client.refused[-1]
        with Client(session.server.url) as other:
            other.ask(do="step")
            other.read(lambda it: it.refused == ['Another viewer steers; {"do": "steer"} takes over.'])


def ball_of(client: Client) -> tuple[float, float]:
    """Where the newest frame of a page has the ball [m]."""
    x, y = np.frombuffer(base64.b64decode(client.chunks[-1]["ball"]), "<i2")[-4:-2] / 1000.0
    return float(x), float(y)


def places_of(client: Client) -> list[list[int]]:
    """Where the newest frame of a page has the robots [mm]."""
    return [numbers(it["rows"], "<i2")[-4:-2].tolist() for it in client.chunks[-1]["robots"]]


def numbers(text: str, kind: str) -> np.ndarray:
    return np.frombuffer(base64.b64decode(text), kind)


def true_places(match: MatchLoop) -> list[list[int]]:
    """Where the robots of a match are before its next tick [mm]."""
    robots = sorted(match.world.truth().robots().items())
    return [[round(1000.0 * it.x), round(1000.0 * it.y)] for _, it in robots]


@pytest.mark.slow
def test_viewers_leave_a_match_of_six_a_side_unharmed() -> None:
    figures = bench_live(load_scenario("team_v_baseline"), sim_world, 90.0, viewers=20)
    print(figures)
    assert figures["memory_mib"] < 300.0
    assert figures["stalled_age_ms"] is not None
    assert figures["stalled_age_ms"] < 2000.0
    assert figures["stalled_skipped"] > 0


def test_a_recording_is_gone_on_with_from_any_time(
    server: Server, scenario: Scenario, tmp_path: Path
) -> None:
    path = tmp_path / "m.robobt.arrows"
    with MatchLoop(scenario, 3, sim_world, path) as match:
        while match.tick():
            pass
    replay = RecordingPlayback(server, path, speed=20.0)
    act(server, Pause(do="pause", on=True))
    showing = threading.Thread(target=replay.show)
    showing.start()
    try:
        with Client(server.url) as client:
            client.read(lambda it: it.state.get("paused"))
            assert client.state["span"] == [0.0, pytest.approx(2.0, abs=0.05)]
            act(server, Seek(do="seek", time=1.5))
            act(server, Pause(do="pause", on=False))
            client.read(lambda it: it.state.get("over"))
            stream = server.audience.stream
            assert stream is not None
            # The end is told at once, and what is on its way is encoded by another thread.
            soon(lambda: stream.end and not stream._encoded)
            saved = parse_recording(stream.recording(), tmp_path)
    finally:
        replay.end()
        showing.join()
    assert saved.times[0] == pytest.approx(1.5, abs=0.03)


def test_a_recording_is_shown_as_it_was_played(server: Server, scenario: Scenario, tmp_path: Path) -> None:
    path = tmp_path / "m.robobt.arrows"
    with MatchLoop(scenario, 3, sim_world, path) as match:
        while match.tick():
            pass
    replay = RecordingPlayback(server, path, start=1.0, speed=20.0)
    showing = threading.Thread(target=replay.show)
    showing.start()
    try:
        with Client(server.url) as client:
            client.read(lambda it: it.state.get("over"))
            assert client.hello["scenario"] == "striker_vs_goalkeeper"
            soon(lambda: server.audience.stream is not None and not server.audience.stream._encoded)
            saved = parse_recording(server.audience.stream.recording(), tmp_path)  # type: ignore[union-attr]
    finally:
        replay.end()
        showing.join()
    recording = load_recording(path)
    skipped = len(recording) - len(saved)
    assert saved.times.tolist() == recording.times[skipped:].tolist()
    assert saved.times[0] == pytest.approx(1.0, abs=0.03)
    for robot in recording.header.robots:
        for tick in range(0, len(saved), 10):
            assert saved.letters_at(robot.id, tick) == recording.letters_at(robot.id, tick + skipped)
            assert saved.feedback_at(robot.id, tick) == recording.feedback_at(robot.id, tick + skipped)
    assert saved.truth.robots.tolist() == recording.truth.robots[skipped:].tolist()
