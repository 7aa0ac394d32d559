"""The cost of viewers for a match: processor time, late ticks, memory; and the delay of a slow viewer."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from time import perf_counter, process_time, sleep, thread_time
from typing import Annotated, TypedDict

import typer
from rich.markup import escape

from robobt.cli import Json, Seed, print_json, say
from robobt.cli.common import Bundled, Imports, errors, import_files
from robobt.live import Live, Server
from robobt.live.session import LATE
from robobt.match import MatchLoop, Scenario, WorldFactory, load_scenario
from robobt.worlds import sim_world

_CLIENT = """
import json, sys, time
from websockets.sync.client import connect
url, host, rate, rest = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
with connect(url, origin=f"http://{host}", max_size=None, max_queue=4, compression=None,
             ping_interval=None) as socket:
    socket.recv()
    print("ready", flush=True)
    time.sleep(rest)
    while True:
        text = socket.recv()
        message = json.loads(text)
        if message["kind"] == "now" and message["chunks"]:
            print(round(1000.0 * time.time() - message["chunks"][-1]["at"], 1), flush=True)
        # The time that these bits take on a link of this rate.
        if rate:
            time.sleep(len(text) * 8.0 / rate)
"""
"""A viewer in a process of its own, which tells how old what it gets is [ms]."""


class LiveFigures(TypedDict):
    """What ``python -m benchmarks live`` measures; its help explains the figures."""

    scenario: str
    seed: int
    seconds: float
    viewers: int
    period: float
    loop_share: float
    tick_cpu_ms: float
    server_share: float
    late_alone: int
    late_watched: int
    ticks: int
    memory_mib: float
    age_median_ms: float | None
    age_p95_ms: float | None
    slow_age_p95_ms: float | None
    stalled_age_ms: float | None
    stalled_skipped: int


class _Viewer:
    """A viewer's process and the ages that it has reported [ms]."""

    def __init__(self, server: Server, rate: float = 0.0, rest: float = 0.0) -> None:
        host = server.url.split("/")[2]
        address = server.url.replace("http", "ws", 1) + "socket"
        arguments = [sys.executable, "-c", _CLIENT, address, host, str(rate), str(rest)]
        self._process = subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True)
        assert self._process.stdout is not None
        self._process.stdout.readline()
        self.ages: list[tuple[float, float]] = []
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def close(self) -> None:
        """End it."""
        self._process.kill()
        self._process.wait()
        self._reading.join()
        assert self._process.stdout is not None
        self._process.stdout.close()

    def _read(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            self.ages.append((perf_counter(), json.loads(line)))


def bench_live(
    scenario: Scenario,
    world_factory: WorldFactory,
    seconds: float = 30.0,
    viewers: int = 1,
    seed: int | None = None,
) -> LiveFigures:
    """Play one match twice over in turns, in real time: alone, and shown to viewers.

    Beside the viewers that read at once there are one on a link of 1 Mbit/s and one that reads nothing
    for the first two thirds of the time. Before that the match is played for a moment, which does
    not count.
    """
    seed = scenario.seed if seed is None else seed
    played = scenario.lasting(seconds + 5.0)
    first = MatchLoop(scenario.lasting(3.0), seed, world_factory)
    first.be_ready()
    first.play()
    period = scenario.period
    with ExitStack() as stack:
        alone = stack.enter_context(MatchLoop(played, seed, world_factory))
        shown = stack.enter_context(MatchLoop(played, seed, world_factory))
        server = stack.enter_context(Server())
        # The pace is kept here.
        live = Live(server, sleep=lambda _: None)
        live.begin(shown)
        play = alone.tick, lambda: live.tick(shown)
        usual = [stack.enter_context(_ending(_Viewer(server))) for _ in range(viewers)]
        slow = stack.enter_context(_ending(_Viewer(server, rate=1e6)))
        stalled = stack.enter_context(_ending(_Viewer(server, rest=2.0 * seconds / 3.0)))
        before = _memory()
        ticks, begun = round(seconds / period), perf_counter()
        loop_begun = thread_time()
        process_begun = process_time()
        busy, late = _in_turns(play, ticks, period)
        others = process_time() - process_begun - (thread_time() - loop_begun)
        took = perf_counter() - begun
        grown = _memory() - before
        sleep(0.5)
        skipped = sum(viewer.skipped for viewer in list(server.audience.viewers.values()))
        if alone.result().trace != shown.result().trace:
            raise RuntimeError("the two matches differ: viewers changed what was played")
    warm = begun + 2.0
    ages = sorted(age for viewer in usual for at, age in viewer.ages if at > warm)
    slow_ages = sorted(age for at, age in slow.ages if at > warm)
    # What a viewer that reads again is shown a second later.
    again = [age for at, age in stalled.ages if at > begun + 2.0 * seconds / 3.0 + 1.0]
    return {
        "scenario": scenario.name,
        "seed": seed,
        "seconds": seconds,
        "viewers": viewers,
        "period": period,
        "loop_share": busy[1] / busy[0] - 1.0,
        "tick_cpu_ms": 1000.0 * busy[0] / ticks,
        "server_share": others / took,
        "late_alone": late[0],
        "late_watched": late[1],
        "ticks": ticks,
        "memory_mib": grown,
        "age_median_ms": ages[len(ages) // 2] if ages else None,
        "age_p95_ms": ages[int(0.95 * len(ages))] if ages else None,
        "slow_age_p95_ms": slow_ages[int(0.95 * len(slow_ages))] if slow_ages else None,
        "stalled_age_ms": max(again) if again else None,
        "stalled_skipped": skipped,
    }


def _in_turns(
    play: tuple[Callable[[], object], Callable[[], object]], ticks: int, period: float
) -> tuple[list[float], list[int]]:
    """Tick two matches in turns at their pace; return the CPU time of each [s] and how often it was late."""
    busy, late = [0.0, 0.0], [0, 0]
    due = perf_counter()
    for tick in range(ticks):
        # The one that goes first finds the caches cold.
        for which in (0, 1) if tick % 2 else (1, 0):
            # Each has half of the period, so that both begin at times of their own.
            due += period / 2
            ahead = due - perf_counter()
            if ahead > 0.0:
                sleep(ahead)
            late[which] += perf_counter() > due + LATE
            start = thread_time()
            play[which]()
            busy[which] += thread_time() - start
            if perf_counter() > due + 0.25:
                due = perf_counter()
    return busy, late


@contextmanager
def _ending(viewer: _Viewer) -> Iterator[_Viewer]:
    try:
        yield viewer
    finally:
        viewer.close()


def _memory() -> float:
    """Return this process's memory [MiB], 0 if unknown."""
    status = Path("/proc/self/status")
    if not status.exists():
        return 0.0
    (line,) = (line for line in status.read_text().splitlines() if line.startswith("VmRSS"))
    return int(line.split()[1]) / 1024.0


def live(
    scenario: Bundled = "team_v_baseline",
    seconds: Annotated[float, typer.Option("--seconds", min=5, max=3600, help="How long to play.")] = 30.0,
    viewers: Annotated[
        int, typer.Option("--viewers", min=1, max=40, help="Viewers that read all that they are sent.")
    ] = 1,
    seed: Seed = None,
    imports: Imports = None,
    as_json: Json = False,
) -> None:
    """Measure what viewers cost a match that is played in real time.

    The match is played twice over in turns: alone, and shown to the viewers, to one on a link of
    1 Mbit/s and to one that reads nothing for two thirds of the time.

    Keys of --json: scenario, seed, seconds, viewers, period; loop_share (by how much more
    processor time the match's own thread takes), tick_cpu_ms (of the match alone),
    server_share (processor time of the other threads, by real time), late_alone and
    late_watched (ticks that began more than 5 ms late, of ticks), memory_mib (by how
    much this process has grown), age_median_ms and age_p95_ms (from a tick to a
    viewer's process), slow_age_p95_ms (on the slow link), stalled_age_ms (the oldest
    that the stalled viewer is shown from one second after it reads again),
    stalled_skipped (how often viewers were sent the present instead).
    """

    import_files(imports)
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)}"):
        figures = bench_live(loaded, sim_world, seconds, viewers, seed)
    if as_json:
        print_json(figures)
        return
    say(
        f"{loaded.name}, {seconds:.0f} s, {viewers} viewers: the match's thread takes "
        f"{figures['loop_share']:+.1%} of {figures['tick_cpu_ms']:.2f} ms a tick, the server "
        f"{figures['server_share']:.1%} of a core; late ticks {figures['late_watched']} of "
        f"{figures['ticks']}, alone {figures['late_alone']}; memory {figures['memory_mib']:+.0f} MiB. "
        f"From tick to viewer "
        f"{figures['age_median_ms']} ms in the median, {figures['age_p95_ms']} ms at 95 %, "
        f"{figures['slow_age_p95_ms']} ms on 1 Mbit/s; one that reads again sees what is "
        f"{figures['stalled_age_ms']} ms old at most."
    )
