"""Plays a match at the viewers' pace, and carries out their requests."""

from __future__ import annotations

import gc
import time
from collections.abc import Callable
from contextlib import suppress
from math import ceil
from queue import Empty

from robobt.live.controls import IDLE_POLL, Controls
from robobt.live.hands import Hands
from robobt.live.messages import Act, Pause, Reset, Speed, Step
from robobt.live.server import Server
from robobt.live.stream import Stream
from robobt.match.loop import MatchLoop
from robobt.match.recording.capture import Capture
from robobt.match.results.results import MatchResult
from robobt.signals import check

LOOK = 1.5
"""Time for which the end of a match is shown before the next [s]."""

LATE = 0.005
"""Delay from which a tick counts as late [s]."""

_TICKS_TO_DELAYS = 60
"""Number of ticks after which measured delays are sent again."""

_GIVE_UP = 0.25
"""Delay from which a match no longer tries to catch up [s]."""


class Live:
    """Plays matches for the viewers of a server.

    Args:
        server: where they watch.
        speed: factor on real time; infinite for as fast as possible.
        paused: whether it waits for a viewer to continue it.
        clock: the time in seconds, that of the server's inbox.
        sleep: function that waits for a number of seconds.

    Attributes:
        ticks: number of ticks played in real time.
        late: number of them that were late by more than :data:`LATE`.
    """

    def __init__(
        self,
        server: Server,
        speed: float = 1.0,
        paused: bool = False,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], None] = time.sleep,
    ) -> None:
        self._server, self._audience, self._nothing_asked = server, server.audience, server.inbox.empty
        self._controls = Controls(server, speed, paused)
        self._clock, self._sleep = clock, sleep
        self._due = 0.0
        self._reset: Reset | None = None
        self._ended = self._paced = False
        # The packed frame of the world since when it stands and viewers may move things in it.
        self._before: bytes | None = None
        self._capture: Capture | None = None
        self._stream: Stream | None = None
        self._hands: Hands | None = None
        # The layers that viewers watch, the names of all layers, and how many of them were sent.
        self._layers: frozenset[str] | None = None
        self._named: set[str] = set()
        self._known = 0
        # Whether every tick is to be attended to, and from one to the next [s].
        self._attentive, self._period = True, 0.0
        self._until_delays = 0
        self.ticks = self.late = 0

    def play_on(self, make: Callable[[int], MatchLoop]) -> None:
        """Play one match after the other at viewers' request, until :meth:`end`.

        ``make`` is called with the trial's number, which decides the seed.
        """
        trial = 0
        while not self._ended:
            with make(trial) as match:
                if self.play(match):
                    # What is recorded is whole, whatever becomes of the page.
                    match.close()
                    self.wait(match)
            if self._reset is not None:
                trial += self._reset.next

    def end(self) -> None:
        """End playing and showing; may be called by any thread."""
        self._ended = True

    def play(self, match: MatchLoop) -> bool:
        """Play a match and return whether it came to its end, which a viewer may not have wanted to see.

        The match is left open.
        """
        self.begin(match)
        while self.tick(match):
            pass
        return match.outcome is not None

    def conduct(self, match: MatchLoop) -> MatchResult:
        """Play a match to its end, show that for a moment, and return the result.

        Raises:
            KeyboardInterrupt: :meth:`end` was called before it was over.
        """
        began = self._clock()
        with match:
            self.begin(match)
            while match.outcome is None:
                if self._ended:
                    raise KeyboardInterrupt
                # Its seed is that of its trial: no other is played in its place.
                self._reset = None
                self.tick(match)
            result = match.result(self._clock() - began)
        self.linger(match, LOOK)
        return result

    def begin(self, match: MatchLoop) -> Hands:
        """Show a match, before its first tick, and return what viewers do to it."""
        match.be_ready()
        if self._capture is not None:
            # What the match before has left.
            gc.unfreeze()
            gc.collect()
        # Looking for garbage among all that is there already would take tenths of a second in the middle of
        # the match. The server gives it back to the collector when it ends.
        gc.freeze()
        self._hands = hands = Hands(match, self._server, self._clock)
        self._show(match)
        self._before = None
        self._stand(match)
        self._reset = None
        self._attentive, self._paced = True, match.world.paced
        self._controls.tell(over=None, countdown=None, delays=None)
        self._due = self._clock()
        return hands

    def tick(self, match: MatchLoop) -> bool:
        """Play one tick of ``match`` when it is due; return False when it is over or no viewer wants it."""
        # Whether anybody wants more than that it is played, which is rare: as little as can be is looked at.
        wanted = (
            self._attentive
            or not self._nothing_asked()
            or self._audience.layers is not self._layers
            or len(self._named) != self._known
            or self._ended
        )
        if wanted and not self._attend(match):
            return False
        if not match.tick():
            self._controls.tell(over=match.outcome and match.outcome.value)
            return False
        self._before = None
        self._until_delays -= 1
        if self._until_delays <= 0:
            self._until_delays = _TICKS_TO_DELAYS
            self._server.tell_delays(match.world.delays())
        self._pace()
        return True

    def count_down(self, match: MatchLoop, seconds: float) -> None:
        """Count down ``seconds`` to the start of ``match`` once somebody is there to drive.

        It starts over whenever nobody is.
        """
        assert self._hands is not None
        end = None
        while not self._ended:
            self._idle(match)
            now = self._clock()
            if not self._hands.driving:
                end = None
                self._controls.tell(countdown="Open this page and click into it to drive")
                continue
            end = now + seconds if end is None else end
            if now >= end:
                break
            self._controls.tell(countdown=str(ceil(end - now)))
        self._controls.tell(countdown=None)
        self._due = self._clock()

    def forget_reset(self) -> None:
        """Go on with the match although a viewer asked for another."""
        self._reset = None

    def linger(self, match: MatchLoop, seconds: float) -> None:
        """Go on showing a ``match`` that is over for ``seconds``."""
        end = self._clock() + seconds
        while self._clock() < end and not self._ended:
            self._idle(match)

    @property
    def ended(self) -> bool:
        """Whether :meth:`end` was called."""
        return self._ended

    def wait(self, match: MatchLoop) -> None:
        """Show a match that is over until a viewer asks for another."""
        while self._reset is None and not self._ended:
            self._idle(match)

    def _attend(self, match: MatchLoop) -> bool:
        """Carry out viewers' requests before the next tick; return False if they want to leave this match."""
        assert self._hands is not None
        while not self._server.inbox.empty():
            self._do(*self._server.inbox.get_nowait(), match)
        while self._controls.wait and not self._paced and self._reset is None and not self._ended:
            self._idle(match)
        if self._reset is not None or self._ended:
            return False
        self._hands.hold(self._clock())
        self._draw()
        self._controls.ticked()
        self._period = match.scenario.period / self._controls.speed
        self._attentive = self._controls.paused or self._hands.holding
        return True

    def _idle(self, match: MatchLoop) -> None:
        """Wait a moment for viewers' requests."""
        check()
        with suppress(Empty):
            self._do(*self._server.inbox.get(timeout=IDLE_POLL), match)
        self._due = self._clock()

    def _show(self, match: MatchLoop, after: Stream | None = None) -> None:
        """Show the match as it is captured now, after what was shown of it before."""
        capture = match.capture()
        if capture is not self._capture:
            self._capture, self._stream = capture, Stream(capture, after)
            self._layers, self._named, self._known = None, capture.layers, 0
            self._server.show(self._stream)

    def _stand(self, match: MatchLoop) -> None:
        """Show where things are until the next tick."""
        assert self._stream is not None
        self._stream.stand(match.world.truth().packed(), self._before)

    def _draw(self) -> None:
        """Let skills draw the layers that viewers watch."""
        assert self._capture is not None
        if self._layers is not self._server.layers:
            self._layers = self._server.layers
            self._capture.look(self._server, self._layers)
        if len(self._named) != self._known:
            self._known = len(self._named)
            self._server.tell(layers=sorted(self._named))

    def _do(self, act: Act, arrived: float, match: MatchLoop) -> None:
        self._attentive = True
        if match.world.paced and isinstance(act, Pause | Step | Speed):
            self._server.say(
                "A field waits for nobody: here the match cannot be paused, stepped or slowed down."
            )
            return
        match act:
            case Pause() | Step() | Speed():
                self._controls.take(act)
            case Reset():
                self._reset = act
            case _ if self._hands is not None:
                stands = self._controls.paused or match.outcome is not None
                if stands and self._before is None:
                    self._before = match.world.truth().packed()
                self._hands.do(act, self._clock(), arrived)
                # Another tree may have begun another capture.
                self._show(match, self._stream)
                if stands:
                    self._stand(match)

    def _pace(self) -> None:
        """Wait for the time of the next tick."""
        if self._paced:
            # The world waits by itself.
            return
        self._due += self._period
        now = self._clock()
        if now < self._due:
            self._sleep(self._due - now)
            now = self._clock()
        self.ticks += 1
        self.late += now > self._due + LATE
        if now > self._due + _GIVE_UP:
            self._due = now
