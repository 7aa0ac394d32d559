"""A served field and a league world in two processes on the loopback, measured."""

from __future__ import annotations

import multiprocessing
import os
import signal
import socket
import time
from math import hypot
from multiprocessing.connection import Connection as Pipe
from typing import Any

import numpy as np

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.serve.serving import served_scenario
from robobt.league.wire.endpoints import VISION_GROUP, Endpoint, Endpoints
from robobt.league.world import Connection, LeagueWorld
from robobt.match.loop import Match
from robobt.match.scenario.scenario import Scenario
from robobt.sim import settings_from
from robobt.world.protocol import Placement
from robobt.world.state import Frame, RobotId

RATE = 60.0
"""Frames a second of the served vision."""

_STALL = 1.0
"""For how long the vision is stopped [s]."""

_START = 60.0
"""How long a process may take to start, compiling included [s]."""

_SLOW = 0.1
"""A robot slower than this stands [m/s]."""


def bench_league(
    scenario: Scenario, seconds: float = 30.0, simulator: str = "grsim", realism: str | None = None
) -> dict[str, Any]:
    """Play a scenario over the loopback against a server in a process of its own.

    Halfway the server is stopped for a second; at the end the playing process is
    killed while its robots drive.

    Args:
        scenario: what is played, at 60 Hz.
        seconds: for how long [s].
        simulator: "grsim" or "protocol".
        realism: of the server; by default the scenario's.

    Returns:
        frame_rate (of the server), tick_rate and command_rate (of the player) [Hz];
        latency_median_ms, latency_p95_ms from frame-in to command-out; ticks,
        robots, lost (robots missing in a frame, summed over ticks), errors (ticks
        a tree failed); stall_command_rate: commands a second while the vision
        stalled [Hz]; stop_commanded_s, stop_at_rest_s: from the kill until every
        robot was under the command to stand still, and stood [s]; dropped: packets.

    Raises:
        RuntimeError: one of the processes died.
    """
    endpoints = _free_endpoints()
    context = multiprocessing.get_context("spawn")
    server_pipe, server_end = context.Pipe()
    player_pipe, player_end = context.Pipe()
    server = context.Process(target=_serve, args=(scenario, endpoints, realism, server_end), daemon=True)
    player = context.Process(
        target=_play, args=(scenario, endpoints, simulator, seconds, player_end), daemon=True
    )
    try:
        server.start()
        _expect(server_pipe, _START)
        player.start()
        _expect(player_pipe, _START)
        time.sleep(seconds / 2)
        stalled = time.monotonic()
        assert server.pid is not None
        assert player.pid is not None
        os.kill(server.pid, signal.SIGSTOP)
        time.sleep(_STALL)
        os.kill(server.pid, signal.SIGCONT)
        resumed = time.monotonic()
        figures, sent = _expect(player_pipe, seconds + _START)
        within = [at for at in sent if stalled + 0.05 <= at < resumed - 0.05]
        figures["stall_command_rate"] = len(within) / (resumed - stalled - 0.1)
        time.sleep(1.0)
        killed = time.monotonic()
        os.kill(player.pid, signal.SIGKILL)
        time.sleep(2.0)
        server_pipe.send((stalled, resumed))
        served = _expect(server_pipe, _START)
    finally:
        for process in (player, server):
            if process.pid is not None:
                process.kill()
                process.join()
    moments = served.pop("moments")
    driven = [at for at, moving, _ in moments if at > killed and moving]
    moving = [at for at, _, speed in moments if at > killed and speed > _SLOW]
    return {
        "scenario": scenario.name,
        "simulator": simulator,
        "seconds": seconds,
        **served,
        **figures,
        "stop_commanded_s": max(driven, default=killed) - killed,
        "stop_at_rest_s": max(moving, default=killed) - killed,
    }


def _free_endpoints() -> Endpoints:
    """Ports that nobody uses at the moment, so that nothing else on this machine interferes."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(8)]
    for sock in sockets:
        sock.bind(("127.0.0.1", 0))
    ports = [sock.getsockname()[1] for sock in sockets]
    for sock in sockets:
        sock.close()
    names = ("grsim", "control", "blue", "yellow", "blue_status", "yellow_status")
    return Endpoints(
        vision=Endpoint(VISION_GROUP, ports[6]),
        tracker=Endpoint(VISION_GROUP, ports[7]),
        **dict(zip(names, ports[:6], strict=True)),
    )


def _expect(pipe: Pipe, seconds: float) -> Any:
    """What the process at the other end says next."""
    if not pipe.poll(seconds):
        raise RuntimeError(f"a process has said nothing for {seconds:g} s")
    try:
        answer = pipe.recv()
    except EOFError as error:
        raise RuntimeError("a process of the measurement died") from error
    if isinstance(answer, str):
        raise RuntimeError(answer)
    return answer


def _serve(scenario: Scenario, endpoints: Endpoints, realism: str | None, pipe: Pipe) -> None:
    try:
        field = served_scenario(scenario, realism=realism)
        field.step()
        moments: list[tuple[float, bool, float]] = []

        def note(field: ServedField) -> None:
            truth = field.truth()
            speed = max((hypot(r.vx, r.vy) for r in (*truth.own, *truth.opponents)), default=0.0)
            moments.append((time.monotonic(), field.driven(), speed))

        with SimServer(field, endpoints) as server:
            pipe.send(True)
            server.run(on_step=note, stop=pipe.poll)
            stalled, resumed = pipe.recv()
            times = np.array([at for at, _, _ in moments])
            running = times[-1] - times[0] - (resumed - stalled)
            dropped = sum(counts.dropped for counts in server.counts.values())
            rate = (len(times) - 1) / running
            pipe.send({"frame_rate": float(rate), "server_dropped": dropped, "moments": moments})
    except Exception as error:
        pipe.send(f"the server failed: {type(error).__name__}: {error}")


class _Timed(LeagueWorld):
    """A league world that notes when it sent, and which robots were missing."""

    def __init__(self, *arguments: Any) -> None:
        self.sends: list[float] = []
        self.lost = 0
        super().__init__(*arguments)

    def reset(self, placement: Placement, seed: int) -> None:
        super().reset(placement, seed)
        self.sends, self.lost = [], 0

    def observe(self) -> Frame:
        frame = super().observe()
        expected = len(self._robots or {})
        self.lost += expected - len(frame.own) - len(frame.opponents)
        return frame

    def _transmit(self) -> None:
        super()._transmit()
        self.sends.append(time.monotonic())


def _play(scenario: Scenario, endpoints: Endpoints, simulator: str, seconds: float, pipe: Pipe) -> None:
    try:
        worlds: list[_Timed] = []

        def world(scenario: Scenario) -> LeagueWorld:
            settings = settings_from(scenario.simulator)
            robots: dict[RobotId, Any] = {
                robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots
            }
            connection = Connection.model_validate({"simulator": simulator, "endpoints": endpoints})
            worlds.append(_Timed(scenario.field, robots, settings, 1 / RATE, connection))
            return worlds[0]

        played = scenario.lasting(seconds + 60.0).model_copy(update={"period": 1 / RATE})
        match = Match(played, scenario.seed, world)
        pipe.send(True)
        began = time.monotonic()
        ticks = 0
        while time.monotonic() - began < seconds + _STALL and match.tick():
            ticks += 1
        elapsed = time.monotonic() - began
        (one,) = worlds
        latencies = np.array(one.latencies) * 1e3
        result = match.result(elapsed)
        figures = {
            "ticks": ticks,
            "robots": len(match.players),
            "lost": one.lost,
            "errors": sum(robot.errors for robot in result.robots.values()),
            "tick_rate": ticks / elapsed,
            "command_rate": len(one.sends) / elapsed,
            "latency_median_ms": float(np.median(latencies)),
            "latency_p95_ms": float(np.percentile(latencies, 95)),
            "dropped": sum(counts.dropped for counts in one.counts().values()),
        }
        pipe.send((figures, one.sends))
        # On until killed.
        while match.tick():
            pass
    except Exception as error:
        pipe.send(f"the player failed: {type(error).__name__}: {error}")
