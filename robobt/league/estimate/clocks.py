"""Clocks of the field and of the cameras' computers, relative to this machine's clock.

The packets with the least delay show the offset between their sender's clock and this machine's; how that
offset changes shows the sender's rate.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import inf, sqrt

from robobt.league.estimate.kalman import Covariance, Mismatch
from robobt.league.wire.vision import CameraFrame

_BLOCK_TIME = 0.0999
"""Duration of a block: packets sent within it compete for the least delay [s of the field].

Cameras send 6 or 10 frames in 0.1 s; with slightly less, rounding does not decide the next frame's block.
"""

_LONGEST_BLOCK = 0.0999
"""Duration of a block of a slow field, by arrival times [s]."""

_FEWEST_BLOCKS = 4
"""Number of blocks after which a block can be odd, and the rate counts as measured."""

_REMEMBERED_BLOCKS = 20
"""Number of blocks whose worst delays are kept."""

_SLOWEST_CLOCK, _FASTEST_CLOCK = 0.05, 20.0
"""Rates beyond these are not believed [s of the field per s]."""

_RATE_ERROR = 1.0
"""Standard deviation of the initial rate, relative to it."""

_RATE_DRIFT, _RATE_CHANGE = 0.03, 0.3
"""Relative drift of a rate, normally and when it evidently changes [1/s]."""

_LEAST_SPREAD, _SPREAD = 0.0003, 0.35
"""Standard deviation of a block's least delay: lower bound [s], and share of the mean delay."""

_FIRST_SPREAD = 0.001
"""Standard deviation of a block's least delay while nothing is known [s]."""

_DELAY_SMOOTHING = 0.2
"""Weight of the newest block in the mean delay."""

_ODD_DELAY, _ODD_DELAY_SPREADS = 0.012, 6.0
"""A block is odd if it is off by more than this [s] and by more than this many standard deviations."""

_ODD, _ODD_TIME = 2, 0.5
"""Number of agreeing odd blocks, and duration [s of the field], after which odd blocks are believed."""

_STRETCH = 2.0
"""Time for which a camera's fastest packet counts [s]."""

_IN_STEP = 0.05
"""Clocks closer than this count as equal, because packets' delays differ by as much [s]."""

_CLOCK_JUMP = 0.5
"""Clocks do not jump ahead this far; a single packet that does so has a wrong timestamp [s]."""

_JUMP_CONFIRMATIONS = 3
"""Consecutive packets after which a clock that jumped ahead is believed."""

_HELD_UP_DELAY, _SET_BACK = 0.2, 0.3
"""Packets later than this are delayed [s]; if that lasts longer than this, the clock was set back [s]."""


@dataclass(slots=True)
class _Block:
    """Consecutive packets of the field: their number, the promptest of them, and how late they were [s].

    Lateness is counted in the field's seconds, from an arbitrary origin.
    """

    first_arrived: float
    first_sent: float
    packets: int = 0
    arrived: float = 0.0
    sent: float = 0.0
    least: float = inf
    total: float = 0.0

    def takes(self, arrived: float, sent: float) -> bool:
        """Return whether a packet with these times belongs here; a pause ends a block."""
        return 0.0 <= sent - self.first_sent < _BLOCK_TIME and arrived - self.first_arrived < _LONGEST_BLOCK

    @property
    def mean_delay(self) -> float:
        """How much later than the promptest the average of the other packets was [s]."""
        return (self.total / self.packets - self.least) * self.packets / max(1, self.packets - 1)


class FieldClock:
    """The field's clock as a function of this machine's: its offset and its rate.

    Packets are taken in blocks; the promptest of each is corrected for the delay that even it is
    likely to have and goes through a Kalman filter of offset and rate. An odd block is held back until others
    confirm it: then the field's clock has jumped, for example because a simulator was paused, or its rate has
    changed, and the estimate restarts.

    All times of this machine are on one monotonic clock.

    ``rate`` is the rate of the field's clock [s of the field per s], and ``settled`` says whether it is
    measured.
    """

    def __init__(self, rate: float = 1.0) -> None:
        self.rate = rate
        self.settled = False
        self._delay = 0.0
        self.clear()

    def clear(self) -> None:
        """Forget the offset after a restart of the field's clock; keep the rate as the best guess."""
        self._known = False
        self._blocks = 0
        self._at = self._sent = 0.0
        self._covariance = Covariance(1.0, 0.0, (_RATE_ERROR * self.rate) ** 2)
        self._mismatch = Mismatch()
        self._late: deque[float] = deque(maxlen=_REMEMBERED_BLOCKS)
        self._block: _Block | None = None
        self._worst = 0.0
        self._odd: list[_Block] = []

    def at(self, time: float) -> float | None:
        """Return the field's time at one of this machine's, None before the first packet [s]."""
        return self._sent + (time - self._at) * self.rate if self._known else None

    @property
    def jitter(self) -> float:
        """Largest recent delay of a packet relative to the fastest one [s of the field]."""
        return max(self._late, default=0.0)

    def update(self, arrived: float, sent: float) -> None:
        """Learn from a packet ``sent`` by the field's clock that ``arrived`` by this machine's [s]."""
        if not self._known:
            self._known, self._at, self._sent = True, arrived, sent
        block = self._block
        if block is None or not block.takes(arrived, sent):
            if block is not None:
                self._close(block)
            block = self._block = _Block(arrived, sent)
            self._worst = 0.0
        now = self.at(arrived)
        assert now is not None
        late = now - sent
        block.packets += 1
        block.total += late
        self._worst = max(self._worst, late)
        if late < block.least:
            block.least, block.arrived, block.sent = late, arrived, sent

    def _close(self, block: _Block) -> None:
        """Use a block that is complete."""
        if self._blocks < _FEWEST_BLOCKS or abs(self._miss(block)) < self._tolerance():
            self._odd.clear()
            self._use(block)
            if self._blocks > _FEWEST_BLOCKS:
                self._late.append(self._worst)
            return
        odd = self._odd
        odd.append(block)
        # The first one's time counts; a flood must not pile up here.
        del odd[1:-_FEWEST_BLOCKS]
        last = odd[-_ODD:]
        agree = all(abs(self._miss(one) - self._miss(block)) < self._tolerance() for one in last)
        # Packets that were held back and arrive all at once carry no information on the delay.
        apart = block.arrived - last[0].arrived > min(_BLOCK_TIME / self.rate, _LONGEST_BLOCK) / 2
        if len(last) == _ODD and agree and apart:
            self._restart(last, _RATE_ERROR / 10)
        elif block.arrived - odd[0].arrived > _ODD_TIME / self.rate:
            self._restart(odd[-_FEWEST_BLOCKS:], _RATE_ERROR)

    def _restart(self, blocks: list[_Block], error: float) -> None:
        """Restart the estimate from some blocks, with the rate known to a relative error."""
        self.clear()
        self._covariance.vv = (error * self.rate) ** 2
        self._known, self._at, self._sent = True, blocks[0].arrived, blocks[0].sent
        for block in blocks:
            self._use(block)

    def _use(self, block: _Block) -> None:
        first = self._blocks == 0
        self._blocks += 1
        if self.settled:
            # Earlier, the delays within a block cannot be separated from the rate.
            self._delay += _DELAY_SMOOTHING * (block.mean_delay - self._delay)
        # The least of n exponentially distributed delays is on average the mean divided by n.
        likely = self._delay / max(1, block.packets)
        spread = max(_LEAST_SPREAD, _SPREAD * self._delay) if self.settled else _FIRST_SPREAD
        p, elapsed = self._covariance, max(0.0, block.arrived - self._at)
        p.predict((_RATE_DRIFT + self._mismatch.level * _RATE_CHANGE) * self.rate, elapsed)
        miss = self._miss(block) + likely
        self._sent += elapsed * self.rate
        self._at += elapsed
        if first:
            self._sent, p.pp, p.pv = block.sent + likely, spread**2, 0.0
            return
        s = p.pp + spread**2
        k, g = p.gains(s)
        p.correct(k, g)
        self._mismatch.update(miss / sqrt(s))
        self._sent += k * miss
        self.rate = min(_FASTEST_CLOCK, max(_SLOWEST_CLOCK, self.rate + g * miss))
        self.settled = self.settled or self._blocks >= _FEWEST_BLOCKS

    def _miss(self, block: _Block) -> float:
        """Return how much later than expected the promptest packet of a block was sent [s of the field]."""
        return block.sent - (self._sent + (block.arrived - self._at) * self.rate)

    def _tolerance(self) -> float:
        """Return how far a block may be off [s of the field]."""
        return max(_ODD_DELAY, _ODD_DELAY_SPREADS * _SPREAD * self._delay)


@dataclass(slots=True)
class _Offset:
    """Least difference between arrival and sending, in this stretch of time and the one before [s]."""

    since: float
    least: float
    before: float
    odd: int = 0
    late_since: float = inf

    @property
    def now(self) -> float:
        return min(self.least, self.before)


class CameraClocks:
    """The offset of each camera's clock from that of the camera heard first."""

    def __init__(self) -> None:
        self._offsets: dict[int, _Offset] = {}

    def clear(self) -> None:
        """Forget all offsets: the clocks were restarted."""
        self._offsets.clear()

    def align(self, frame: CameraFrame, arrived: float) -> None:
        """Convert a frame that ``arrived`` by this machine's clock to the first camera's clock [s]."""
        apart = self.shift(frame.camera, arrived, frame.sent)
        frame.captured += apart
        frame.sent += apart

    def shift(self, camera: int, arrived: float, sent: float) -> float:
        """Return what to add to a camera's timestamps to convert them to the first camera's clock [s].

        The packet in hand was ``sent`` by the camera's own clock and ``arrived`` by this machine's [s].
        """
        offset = arrived - sent
        known = self._offsets.get(camera)
        if known is None:
            known = self._offsets[camera] = _Offset(arrived, offset, offset)
        elif offset < known.now - _CLOCK_JUMP and known.odd + 1 < _JUMP_CONFIRMATIONS:
            known.odd += 1
            return 0.0
        elif offset <= known.now + _HELD_UP_DELAY:
            known.late_since = inf
        elif arrived - known.late_since > _SET_BACK:
            known = self._offsets[camera] = _Offset(arrived, offset, offset)
        else:
            known.late_since = min(known.late_since, arrived)
        if arrived - known.since > _STRETCH:
            known.since, known.before, known.least = arrived, known.least, offset
        known.odd = 0
        known.least = min(known.least, offset)
        first = next(iter(self._offsets.values()))
        apart = known.now - first.now
        return apart if abs(apart) > _IN_STEP else 0.0
