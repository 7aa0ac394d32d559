"""How well a league world knows the time on a field whose clock is not this machine's, measured.

The field and this machine's clock are simulated: nothing is sent, and there is no waiting.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Annotated, Literal

import numpy as np
import typer
from numpy.typing import NDArray

from benchmarks.league import free_endpoints
from robobt.cli import MAX_SEED, Json, console, print_json, table
from robobt.cli.common import errors
from robobt.league.connection import Connection
from robobt.league.known_field import KnownField
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.league.world import LeagueWorld
from robobt.world import RobotId, Team

Fault = Literal["none", "frozen", "lost", "queued", "restart"]
"""What happens now and then: nothing; the field's clock stands still; packets are lost, or arrive late
and all at once; the field is restarted, its clock beginning at 0."""

FAULTS: tuple[Fault, ...] = ("none", "frozen", "lost", "queued", "restart")

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)
"""Mean rates of the clocks that are tried [s of the field per s]."""

_RATE = 60.0
"""Frames per second of the field [Hz]."""

_DRIFT_PERIOD = 10.0
"""Period of the rate's drift [s]."""

_STEP = 1e-3
"""Step in which the field's clock is integrated [s]."""

_EVERY, _LASTS = 5.0, 0.5
"""How often the fault happens and for how long [s]."""


@dataclass(frozen=True, slots=True)
class Peer:
    """A field whose clock runs at a rate of its own, and whose packets are delayed irregularly.

    Attributes:
        speed: mean rate of its clock [s of the field per s].
        drift: amplitude of the rate's drift, as a share of it.
        jitter: packets are up to this late, equally distributed [s].
        fault: what happens every five seconds, for half a second.
    """

    speed: float = 1.0
    drift: float = 0.02
    jitter: float = 0.005
    fault: Fault = "none"


class PeerClock:
    """The clock of a peer, and when its frames arrive.

    It is followed for ``seconds``; the phase of its drift, and the delays, follow from ``seed``.

    Attributes:
        faults: when faults begin [s].
        frames: when frames arrive on this machine's clock and what the peer's showed when they were sent,
            in the order of arrival [s, s].
    """

    def __init__(self, peer: Peer, seconds: float, seed: int = 0) -> None:
        random = np.random.default_rng(seed)
        times = self._times = np.arange(0.0, seconds + _EVERY, _STEP)
        phases = times / _DRIFT_PERIOD + random.uniform()
        rates = peer.speed * (1.0 + peer.drift * np.sin(2 * pi * phases))
        self.faults = [] if peer.fault == "none" else np.arange(_EVERY, seconds, _EVERY).tolist()
        ends = np.add(self.faults, _LASTS)
        faulty = np.searchsorted(self.faults, times, "right") > np.searchsorted(ends, times, "right")
        if peer.fault == "frozen":
            rates[faulty] = 0.0
        ran = np.concatenate([[0.0], np.cumsum(rates[:-1] * _STEP)])
        # A clock that stands still shows one time for long; the frame of that time is sent first.
        rising = ran + 1e-12 * np.arange(len(ran))
        sent = np.interp(np.arange(1, int(ran[-1] * _RATE)) / _RATE, rising, times)
        self._shows = ran
        if peer.fault == "restart":
            starts = np.interp([0.0, *ends], times, ran)
            self._shows = ran - starts[np.searchsorted(ends, times, "right")]
        arrives = sent + random.uniform(0.0, peer.jitter, len(sent))
        shown = np.array([self.shows(time) for time in sent])
        held = faulty[(sent / _STEP).astype(int)]
        if peer.fault in ("lost", "restart"):
            arrives, shown = arrives[~held], shown[~held]
        elif peer.fault == "queued":
            arrives[held] = ends[np.searchsorted(ends, sent[held], "right")]
        order = np.argsort(arrives, kind="stable")
        self.frames = list(zip(arrives[order].tolist(), shown[order].tolist(), strict=True))

    def shows(self, time: float) -> float:
        """Return what the clock shows at a time of this machine [s]."""
        return float(np.interp(time, self._times, self._shows))


class PeerWorld(LeagueWorld):
    """A league world under a simulated clock that is handed a peer's frames.

    ``known`` is what earlier worlds have found out; ``machine_time`` is this machine's clock [s].
    """

    def __init__(self, peer: PeerClock, known: KnownField | None = None) -> None:
        self.machine_time = 0.0
        self._peer = peer
        self._waiting = peer.frames[::-1]
        connection = Connection(simulator="observer", endpoints=free_endpoints())
        super().__init__(connection=connection, clock=lambda: self.machine_time, known=known)
        self._feed.receive = self._receive  # type: ignore[method-assign]

    def lead(self) -> float:
        """Return how far the present frame is ahead of what is there [s]."""
        return self._looked_at - self._peer.shows(self.machine_time)

    def _receive(self, wait: float) -> None:
        end = self.machine_time + max(0.0, wait)
        if not self._waiting or self._waiting[-1][0] > end:
            self.machine_time = end
            return
        self.machine_time = max(self.machine_time, self._waiting[-1][0])
        while self._waiting and self._waiting[-1][0] <= self.machine_time:
            self._feed.add(_frame(self._waiting.pop()[1]), self.machine_time)


def lead_errors(
    peer: Peer, seconds: float = 20.0, seed: int = 0, settling: float = 1.0
) -> NDArray[np.float64]:
    """Return how far each frame was predicted beyond what was there at that moment [s].

    ``settling`` is how long after the start and after the end of a fault nothing is judged [s].
    """
    errors = []
    clock = PeerClock(peer, seconds, seed)
    with PeerWorld(clock, _Silent()) as world:
        while world.machine_time < seconds:
            world.act({})
            since = [world.machine_time - fault for fault in clock.faults]
            if world.machine_time >= settling and not any(0.0 <= ago < _LASTS + settling for ago in since):
                errors.append(world.lead())
    return np.array(errors)


def lead_figures(peer: Peer, seconds: float = 20.0, seed: int = 0) -> dict[str, float]:
    """Return number of frames, bias, mean, 99th percentile and largest of :func:`lead_errors` [s]."""
    errors = lead_errors(peer, seconds, seed)
    sizes = np.abs(errors)
    return {
        "frames": len(errors),
        "bias": float(errors.mean()),
        "mean_error": float(sizes.mean()),
        "p99_error": float(np.quantile(sizes, 0.99)),
        "largest_error": float(sizes.max()),
    }


class _Silent(KnownField):
    """Sends nothing."""

    def tell(self, what: str, message: str) -> None:
        """Do nothing."""

    def tell_again(self, message: str) -> None:
        """Do nothing."""


def _frame(time: float) -> CameraFrame:
    robot = RobotDetection(RobotId(Team.BLUE, 0), 1.0, 0.0, 0.0)
    return CameraFrame(0, 0, time, time, [BallDetection(0.0, 0.0)], [robot])


def clock(
    seconds: Annotated[
        float, typer.Option("--seconds", min=5, max=3600, help="How long each is followed.")
    ] = 30.0,
    jitter: Annotated[
        float, typer.Option("--jitter", min=0, max=0.1, help="Longest irregular delay of a packet, s.")
    ] = 0.005,
    drift: Annotated[
        float, typer.Option("--drift", min=0, max=0.1, help="How far the rate drifts, as a share.")
    ] = 0.02,
    seed: Annotated[int, typer.Option("--seed", "-s", min=0, max=MAX_SEED)] = 0,
    as_json: Json = False,
) -> None:
    """Measure how well the time on a simulated field is known whose clock runs at a rate of its own.

    The lead is the time for which a frame is predicted less what the field's clock shows
    then. Every five seconds the field stands still for half a second, or its packets are lost
    or come late, or it is restarted; the second after is not judged.

    Keys of --json: seconds, jitter, drift, seed; rows, each with speed, fault, frames,
    bias, mean_error, p99_error, largest_error (s).
    """

    peers = [Peer(speed, drift, jitter, fault) for speed in SPEEDS for fault in FAULTS]
    with errors.status("following clocks"):
        rows = [(peer, lead_figures(peer, seconds, seed)) for peer in peers]
    if as_json:
        given = {"seconds": seconds, "jitter": jitter, "drift": drift, "seed": seed}
        listed = [{"speed": peer.speed, "fault": peer.fault, **figures} for peer, figures in rows]
        print_json({**given, "rows": listed})
        return
    shown = table("speed", "fault", "frames", "bias, ms", "mean error, ms", "p99, ms", "largest, ms")
    for peer, figures in rows:
        times = [figures[name] for name in ("bias", "mean_error", "p99_error", "largest_error")]
        in_ms = [f"{time * 1e3:.2f}" for time in times]
        shown.add_row(f"{peer.speed:g}", peer.fault, f"{figures['frames']:g}", *in_ms)
    console.print(shown)
