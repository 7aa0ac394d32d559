"""A served field and a league world in two processes on the loopback, measured."""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
from collections.abc import Callable
from contextlib import ExitStack
from math import hypot
from multiprocessing.connection import Connection as Pipe
from typing import Annotated, Any

import numpy as np
import typer
from rich.markup import escape

from robobt.cli import Json, print_json, say
from robobt.cli.common import Bundled, errors
from robobt.config.systems import need_posix
from robobt.league.connection import Connection
from robobt.league.serve.served_field import ServedField, served_scenario
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import VISION_GROUP, Endpoint, Endpoints
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Receiver
from robobt.league.world import LeagueWorld
from robobt.match import MatchLoop, Scenario, load_scenario
from robobt.sim import settings_from
from robobt.world import Frame

RATE = 60.0
"""Frame rate of the served vision [Hz]."""

_STALL = 1.0
"""How long the vision is stopped [s]."""

_START = 60.0
"""Longest start of a process, compiling included [s]."""

_AT_REST = 0.1
"""A robot slower than this is at rest [m/s]."""


def bench_league(
    scenario: Scenario, seconds: float = 30.0, simulator: str = "grsim", realism: str | None = None
) -> dict[str, float]:
    """Play a scenario over the loopback against a server in a process of its own.

    Halfway the server is stopped for a second; at the end the playing process is
    killed while its robots drive.

    Args:
        scenario: what is played, at 60 Hz.
        seconds: for how long [s].
        simulator: "grsim" or "protocol".
        realism: of the server; by default the scenario's.

    Returns:
        Rates of the server's frames, and of the player's ticks and commands, also while the
        vision stalled [Hz]; latency from a frame's arrival to the commands; robots missing in
        frames, summed over the ticks; ticks in which a tree failed; dropped packets; and the
        time from the kill until all robots were commanded to stop, and stood [s].
    """
    need_posix("stopping a process for a while, as the benchmark does,")
    endpoints = free_endpoints()
    context = multiprocessing.get_context("spawn")
    server_pipe, server_end = context.Pipe()
    player_pipe, player_end = context.Pipe()
    server = context.Process(
        target=_report_failure, args=(_serve, server_end, scenario, endpoints, realism), daemon=True
    )
    player = context.Process(
        target=_report_failure, args=(_play, player_end, scenario, endpoints, simulator, seconds), daemon=True
    )
    try:
        server.start()
        _expect(server_pipe, _START)
        player.start()
        _expect(player_pipe, _START)
        time.sleep(seconds / 2)
        stalled = time.monotonic()
        assert server.pid is not None
        os.kill(server.pid, signal.SIGSTOP)
        time.sleep(_STALL)
        os.kill(server.pid, signal.SIGCONT)
        resumed = time.monotonic()
        figures, sent = _expect(player_pipe, seconds + _START)
        within = [at for at in sent if stalled + 0.05 <= at < resumed - 0.05]
        time.sleep(1.0)
        killed = time.monotonic()
        player.kill()
        time.sleep(2.0)
        server_pipe.send((stalled, resumed))
        served, moments = _expect(server_pipe, _START)
    finally:
        for process in (player, server):
            if process.pid is not None:
                process.kill()
                process.join()
    driven = [at for at, moving, _ in moments if at > killed and moving]
    moving = [at for at, _, speed in moments if at > killed and speed > _AT_REST]
    return {
        **served,
        **figures,
        "stall_command_rate": len(within) / (resumed - stalled - 0.1),
        "stop_commanded_s": max(driven, default=killed) - killed,
        "stop_at_rest_s": max(moving, default=killed) - killed,
    }


def free_endpoints() -> Endpoints:
    """Return ports that are free at the moment, so that nothing else on this machine interferes."""
    names = [name for name in Endpoints.model_fields if name != "referee"]
    with ExitStack() as opened:
        ports = {name: opened.enter_context(Receiver(LOOPBACK_ADDRESS, 0)).port for name in names}
    groups = {name: Endpoint(VISION_GROUP, ports.pop(name)) for name in ("vision", "tracker")}
    return Endpoints.model_validate(ports | groups)


def _expect(pipe: Pipe, seconds: float) -> Any:
    """Return what the process at the other end sends next."""
    if not pipe.poll(seconds):
        raise RuntimeError(f"a process of the measurement has been silent for {seconds:g} s")
    try:
        answer = pipe.recv()
    except EOFError as error:
        raise RuntimeError("a process of the measurement died") from error
    if isinstance(answer, str):
        raise RuntimeError(answer)
    return answer


def _report_failure(run: Callable[..., None], pipe: Pipe, *arguments: object) -> None:
    """Run in a process of its own, and send the message of an error."""
    try:
        run(pipe, *arguments)
    except Exception as error:
        pipe.send(f"{run.__name__} failed: {type(error).__name__}: {error}")


def _serve(pipe: Pipe, scenario: Scenario, endpoints: Endpoints, realism: str | None) -> None:
    field = served_scenario(scenario, realism=realism)
    field.step()
    moments: list[tuple[float, bool, float]] = []

    def note(field: ServedField) -> None:
        robots = field.truth().robots().values()
        speed = max((hypot(robot.vx, robot.vy) for robot in robots), default=0.0)
        moments.append((time.monotonic(), field.driven(), speed))

    with SimServer(field, endpoints) as server:
        pipe.send(True)
        server.run(on_step=note, stop=pipe.poll)
        stalled, resumed = pipe.recv()
        running = moments[-1][0] - moments[0][0] - (resumed - stalled)
        dropped = sum(counts.dropped for counts in server.counts.values())
        pipe.send(({"frame_rate": (len(moments) - 1) / running, "server_dropped": dropped}, moments))


class _CountingWorld(LeagueWorld):
    """A league world that counts the robots missing in its frames."""

    lost = 0

    def observe(self) -> Frame:
        frame = super().observe()
        self.lost += len(self._robots or ()) - len(frame.robots())
        return frame


def _play(pipe: Pipe, scenario: Scenario, endpoints: Endpoints, simulator: str, seconds: float) -> None:
    settings = settings_from(scenario.simulator)
    robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    connection = Connection.model_validate({"simulator": simulator, "endpoints": endpoints})
    world = _CountingWorld(scenario.field, robots, settings, 1 / RATE, connection)
    played = scenario.lasting(seconds + 60.0).model_copy(update={"period": 1 / RATE})
    match = MatchLoop(played, scenario.seed, lambda _: world)
    pipe.send(True)
    began = time.monotonic()
    ticks = 0
    while time.monotonic() - began < seconds + _STALL and match.tick():
        ticks += 1
    elapsed = time.monotonic() - began
    latencies = np.array(world.latencies) * 1e3
    result = match.result(elapsed)
    figures = {
        "ticks": ticks,
        "robots": len(match.players),
        "lost": world.lost,
        "errors": sum(robot.errors for robot in result.robots.values()),
        "tick_rate": ticks / elapsed,
        "command_rate": len(world.send_times) / elapsed,
        "latency_median_ms": float(np.median(latencies)),
        "latency_p95_ms": float(np.percentile(latencies, 95)),
        "dropped": sum(counts.dropped for counts in world.counts().values()),
    }
    pipe.send((figures, list(world.send_times)))
    # Play on until killed.
    while match.tick():
        pass


def league(
    scenario: Bundled = "six_v_six",
    seconds: Annotated[float, typer.Option("--seconds", min=4, max=3600, help="How long to play.")] = 30.0,
    simulator: Annotated[str, typer.Option("--simulator", help="grsim or protocol.")] = "grsim",
    realism: Annotated[
        str | None, typer.Option("--realism", help="Of the server; by default the scenario's.")
    ] = None,
    as_json: Json = False,
) -> None:
    """Play against a served field in a second process over the loopback, at 60 Hz.

    Halfway the vision stalls for a second; at the end the playing process is killed.

    Keys of --json: scenario, simulator, seconds, frame_rate, tick_rate,
    command_rate, stall_command_rate (Hz), latency_median_ms, latency_p95_ms
    (from a frame's arrival to the commands), ticks, robots, lost (robots missing in frames),
    errors (ticks a tree failed), dropped, server_dropped (packets),
    stop_commanded_s and stop_at_rest_s (from the kill until all robots
    are commanded to stop, and stand).
    """

    if simulator not in ("grsim", "protocol"):
        raise typer.BadParameter(f"{simulator!r} must be grsim or protocol", param_hint="--simulator")
    loaded = load_scenario(scenario)
    with errors.status(f"playing {escape(loaded.name)} over the loopback"):
        figures = bench_league(loaded, seconds, simulator, realism)
    if as_json:
        print_json({"scenario": loaded.name, "simulator": simulator, "seconds": seconds} | figures)
        return
    say(
        f"{loaded.name} over {simulator}, {figures['robots']} robots, {figures['ticks']} ticks: vision "
        f"{figures['frame_rate']:.2f} Hz, ticks {figures['tick_rate']:.2f} Hz, commands "
        f"{figures['command_rate']:.2f} Hz ({figures['stall_command_rate']:.2f} Hz while the vision stalled)."
    )
    say(
        f"From a frame's arrival to the commands: median {figures['latency_median_ms']:.2f} ms, 95 % within "
        f"{figures['latency_p95_ms']:.2f} ms. Robots lost {figures['lost']}, errors {figures['errors']}, "
        f"packets dropped {figures['dropped'] + figures['server_dropped']}."
    )
    say(
        f"Player killed: robots commanded to stop after {figures['stop_commanded_s']:.2f} s, at rest after "
        f"{figures['stop_at_rest_s']:.2f} s."
    )
