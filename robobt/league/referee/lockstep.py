"""The official game controller one step at a time: its clock stands still between two of our messages.

Source of messages: ssl-game-controller, ``ci/ci.go`` and ``engine/``. Each message with a time makes one
tick, which is answered at once with the state before its consequences. Consequences (an automatic command, an
event that the controller raises) are queued, and so are the changes that we send; each is answered when it is
done and may queue further ones. Answers do not name their request, and a tick that meets a non-empty queue
repeats the waiting entries or even crashes the controller. So a tick is sent only after all earlier entries
are done: a change of the status message is answered after everything queued before it, and alone once the
queue was empty.
"""

from __future__ import annotations

from collections.abc import Sequence

from robobt.league.referee.process import GameControllerError
from robobt.league.wire.messages import (
    Change,
    CiInput,
    CiOutput,
    Config,
    DecodeError,
    Referee,
    SSL_GeometryData,
)
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.league.wire.tracker import fill_tracked
from robobt.world.state import Frame

EPOCH = 1_700_000_000
"""The controller's clock at the start of the match [s]; any time except 0 works."""

_MOST_CONSEQUENCES = 50
"""More consequences than one change has ever had."""

_RESTLESS = "the game controller does not come to rest"

_SILENCE = 10.0
"""Time without an answer after which the controller counts as failed [s]."""

_TRACKER = "robobt"


class LockstepController:
    """Drives a controller in its simulation mode over ``stream``.

    Attributes:
        asked: whether it has been asked and its answer not been taken yet.

    Raises:
        GameControllerError: of all methods: the controller is silent, has closed the connection or does not
            send what it should.
    """

    def __init__(self, stream: MessageStream) -> None:
        self._stream = stream
        self._frames = self._changes = 0
        self.asked = False

    def ask(
        self, seconds: float, frame: Frame | None = None, geometry: SSL_GeometryData | None = None
    ) -> None:
        """Set the clock, which makes the controller look at the match; :meth:`answer` waits for what it says.

        Args:
            seconds: simulated time [s].
            frame: what is on the field, seen from blue's side.
            geometry: the field; once, after the division was sent.
        """
        message = CiInput(timestamp=EPOCH * 1_000_000_000 + round(seconds * 1e9))
        if frame is not None:
            self._frames += 1
            fill_tracked(message.tracker_packet, frame, self._frames, EPOCH + seconds, _TRACKER)
        if geometry is not None:
            message.geometry.CopyFrom(geometry)
        self._send(message)
        self.asked = True

    def answer(self) -> list[Referee]:
        """Return the controller's answer to the last tick: the state before its consequences."""
        self.asked = False
        return [self._next()]

    def change(self, changes: Sequence[Change], config: Config | None = None) -> list[Referee]:
        """Change the match at once, without time passing; return the controller's answers.

        Changes are made in their order. One that it ignores is left out without a word.

        Args:
            changes: what to change.
            config: what to change before that in how the controller works.
        """
        said: list[Referee] = []
        for number, change in enumerate(changes):
            # One at a time: more than ten answers at once and it drops some.
            message = CiInput()
            if config is not None and number == 0:
                message.api_inputs.add().config_delta.CopyFrom(config)
            message.api_inputs.add().change.CopyFrom(change)
            said += self._marked(message)
        return said + self.rest()

    def rest(self) -> list[Referee]:
        """Wait until all consequences of the last tick are done, and return the controller's answers."""
        said: list[Referee] = []
        for _ in range(_MOST_CONSEQUENCES):
            answers = self._marked(CiInput())
            said += answers
            if len(answers) == 1:
                return said
        raise GameControllerError(_RESTLESS)

    def _marked(self, message: CiInput) -> list[Referee]:
        """Send a message of changes; return the answers until it and everything before it are done."""
        # Changes are done in order, so this one's answer comes after all of those.
        self._changes += 1
        done = f"{_TRACKER} {self._changes}"
        message.api_inputs.add().change.set_status_message_change.status_message = done
        self._send(message)
        said: list[Referee] = []
        for _ in range(_MOST_CONSEQUENCES):
            said.append(self._next())
            if said[-1].status_message == done:
                return said
        raise GameControllerError(_RESTLESS)

    def _next(self) -> Referee:
        try:
            data = self._stream.receive(_SILENCE)
            if data is None:
                raise GameControllerError(f"the game controller has not answered for {_SILENCE:.0f} s")
            output = CiOutput.FromString(data)
        except StreamError as error:
            raise GameControllerError(str(error)) from error
        except (DecodeError, ValueError) as error:
            raise GameControllerError("the game controller sends what is no message of it") from error
        if not output.HasField("referee_msg") or not output.IsInitialized():
            raise GameControllerError("the game controller sends a message without the state of the match")
        message: Referee = output.referee_msg
        return message

    def _send(self, message: CiInput) -> None:
        try:
            self._stream.send(message.SerializeToString())
        except StreamError as error:
            raise GameControllerError(str(error)) from error
