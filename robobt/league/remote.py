"""Clients of the game controller in a real match: team, automatic referee and remote control.

Source of the handshake and the signatures: ssl-game-controller, ``rcon/*.go``.
"""

from __future__ import annotations

import socket
import subprocess
from pathlib import Path
from typing import Any, TypeVar

from robobt.config.closing import Closing
from robobt.config.errors import RobobtError, one_line
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import (
    AutoRefRegistration,
    AutoRefToController,
    ControllerReply,
    ControllerToAutoRef,
    ControllerToRemoteControl,
    ControllerToTeam,
    DecodeError,
    Message,
    RemoteControlRegistration,
    RemoteControlTeamState,
    RemoteControlToController,
    TeamRegistration,
    TeamToController,
)
from robobt.league.wire.sockets import LOOPBACK_ADDRESS
from robobt.league.wire.stream import MessageStream, StreamError, encode_varint
from robobt.match.referee.events import RefereeEvent
from robobt.world.game import Team

TEAM_PORT, AUTOREF_PORT, REMOTE_PORT = 10008, 10007, 10011
"""Where the game controller listens for teams, automatic referees and remote controls."""

_CONTROLLER_TIMEOUT = 5.0
"""Longest wait for the controller [s]."""

_Answer = TypeVar("_Answer", bound=Message)


class RemoteError(RobobtError, RuntimeError):
    """The game controller is not there, or refuses; the message has its reason."""


class _Connection(Closing):
    """A registered connection; every message is answered before the next. A context manager.

    With a ``key``, a file with the private RSA key whose public one the controller trusts, messages are
    signed. That takes the program ``openssl``.
    """

    def __init__(
        self, registration: Any, answers: type[_Answer], address: tuple[str, int], key: Path | None
    ) -> None:
        self._key, self._answers, self._token = key, answers, ""
        where = f"the game controller at {address[0]}:{address[1]}"
        try:
            self._stream = MessageStream(
                socket.create_connection(address, timeout=_CONTROLLER_TIMEOUT), where
            )
        except OSError as error:
            raise RemoteError(f"{where} cannot be reached: {error.strerror or error}") from error
        try:
            self._answer()
            self._tell(registration)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the connection; the controller forgets the advantage choice of a team."""
        self._stream.close()

    def _tell(self, message: Any) -> Any:
        """Send a message and return the answer.

        Raises:
            RemoteError: it is refused, or the controller has gone.
        """
        if self._key is not None:
            message.signature.token, message.signature.pkcs1v15 = self._token, b""
            message.signature.pkcs1v15 = sign(as_signed(message), self._key)
        try:
            self._stream.send(message.SerializeToString())
        except StreamError as error:
            raise RemoteError(str(error)) from error
        return self._answer()

    def _answer(self) -> Any:
        try:
            data = self._stream.receive(_CONTROLLER_TIMEOUT)
            answer: Any = None if data is None else self._answers.FromString(data)
        except (StreamError, DecodeError) as error:
            raise RemoteError(f"the game controller breaks off: {error}") from error
        if answer is None:
            raise RemoteError("the game controller does not answer")
        reply: ControllerReply = answer.controller_reply
        if reply.next_token:
            self._token = reply.next_token
        if reply.status_code == ControllerReply.REJECTED:
            raise RemoteError(f"the game controller refuses: {one_line(reply.reason)}")
        return answer


class TeamConnection(_Connection):
    """Requests of a team's program.

    Args:
        name: the team's name as the controller has it.
        team: its colour; needed where both teams have the same name.
        host, port: where the controller listens for teams.
        key: file with the team's private key; None for a team that the controller knows no key of.

    Raises:
        RemoteError: of all methods: the controller is not there, or refuses.
    """

    def __init__(
        self,
        name: str,
        team: Team | None = None,
        host: str = LOOPBACK_ADDRESS,
        port: int = TEAM_PORT,
        key: Path | None = None,
    ) -> None:
        registration = TeamRegistration(team_name=name, team=None if team is None else team.name)
        super().__init__(registration, ControllerToTeam, (host, port), key)

    def keeper(self, number: int) -> None:
        """Name robot ``number`` goalkeeper; refused while the ball is in play or being prepared for it."""
        self._tell(TeamToController(desired_keeper=number))

    def substitute(self, wanted: bool = True) -> None:
        """Ask for the next chance to exchange robots, or take that back unless ``wanted``."""
        self._tell(TeamToController(substitute_bot=wanted))

    def advantage(self, play_on: bool) -> None:
        """Say whether to ``play_on`` when the opponents have too many robots; holds until it is changed."""
        self._tell(TeamToController(advantage_choice="CONTINUE" if play_on else "STOP"))

    def ping(self) -> None:
        """Show that the connection still works."""
        self._tell(TeamToController(ping=True))


class AutoRefConnection(_Connection):
    """An automatic referee that reports game events.

    Args:
        name: what it is called.
        host, port: where the controller listens for automatic referees.
        key: file with its private key; None for one that the controller knows no key of.

    Raises:
        RemoteError: of all methods: the controller is not there, or refuses.
    """

    def __init__(
        self, name: str, host: str = LOOPBACK_ADDRESS, port: int = AUTOREF_PORT, key: Path | None = None
    ) -> None:
        self._name = name
        super().__init__(AutoRefRegistration(identifier=name), ControllerToAutoRef, (host, port), key)

    def report(self, event: RefereeEvent, epoch: float) -> None:
        """Report what was seen; ``epoch`` is the Unix time at which the event's clock was 0 [s]."""
        self._tell(AutoRefToController(game_event=write_event(event, epoch, self._name)))


class RemoteControl(_Connection):
    """A team's remote control, as its robot handler has it.

    Args:
        team: whose it is.
        host, port: where the controller listens for remote controls.
        key: file with its private key; None where the controller knows none for this colour.

    Raises:
        RemoteError: of all methods: the controller is not there, or refuses.
    """

    def __init__(
        self, team: Team, host: str = LOOPBACK_ADDRESS, port: int = REMOTE_PORT, key: Path | None = None
    ) -> None:
        registration = RemoteControlRegistration(team=team.name)
        super().__init__(registration, ControllerToRemoteControl, (host, port), key)

    def state(self) -> RemoteControlTeamState:
        """Return the controller's data on the team: allowed requests, remaining budgets, cards."""
        return self._asked(RemoteControlToController(request="PING"))

    def keeper(self, number: int) -> RemoteControlTeamState:
        """Name the robot ``number`` goalkeeper; refused while the ball is in play in the own half.

        Returns the team's state.
        """
        return self._asked(RemoteControlToController(desired_keeper=number))

    def substitute(self, wanted: bool = True) -> RemoteControlTeamState:
        """Ask for the next chance to exchange robots, or take that back unless ``wanted``.

        Returns the team's state.
        """
        return self._asked(RemoteControlToController(request_robot_substitution=wanted))

    def timeout(self, wanted: bool = True) -> RemoteControlTeamState:
        """Ask for a time-out at the next stop, or take that back unless ``wanted``.

        Returns the team's state.
        """
        return self._asked(RemoteControlToController(request_timeout=wanted))

    def end_timeout(self) -> RemoteControlTeamState:
        """End the own time-out and return the team's state."""
        return self._asked(RemoteControlToController(request="STOP_TIMEOUT"))

    def forced_timeout(self, wanted: bool = True) -> RemoteControlTeamState:
        """Ask for a stop within 10 s, at the cost of a yellow card, or take that back unless ``wanted``.

        Returns the team's state.
        """
        return self._asked(RemoteControlToController(request_emergency_stop=wanted))

    def challenge(self) -> RemoteControlTeamState:
        """Raise a challenge flag and return the team's state."""
        return self._asked(RemoteControlToController(request="CHALLENGE_FLAG"))

    def give_up_placement(self) -> RemoteControlTeamState:
        """Give up placing the ball and return the team's state."""
        return self._asked(RemoteControlToController(request="FAIL_BALLPLACEMENT"))

    def _asked(self, message: RemoteControlToController) -> RemoteControlTeamState:
        state: RemoteControlTeamState = self._tell(message).state
        return state


def as_signed(message: Message) -> bytes:
    """Return the bytes of a message as the controller has them when it checks a signature.

    It reads a message and writes it again, fields of a *oneof* last: Go's order.
    """
    out = bytearray()
    fields = sorted(message.ListFields(), key=lambda it: (it[0].containing_oneof is not None, it[0].number))
    for field, value in fields:
        if field.message_type is None:
            only: Any = type(message)()
            if isinstance(value, str | bytes | int | float):
                setattr(only, field.name, value)
            else:
                getattr(only, field.name).extend(value)
            out += only.SerializePartialToString()
            continue
        for part in [value] if isinstance(value, Message) else value:
            data = as_signed(part)
            out += encode_varint(field.number << 3 | 2) + encode_varint(len(data)) + data
    return bytes(out)


def sign(data: bytes, key: Path) -> bytes:
    """Return the signature of data by a private RSA key: SHA-256, PKCS #1 v1.5.

    Raises:
        RemoteError: there is no program ``openssl``, or the file is no such key.
    """
    try:
        command = ["openssl", "dgst", "-sha256", "-sign", str(key)]
        done = subprocess.run(
            command, input=data, capture_output=True, timeout=_CONTROLLER_TIMEOUT, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise RemoteError(f"messages are signed by the program openssl, which fails: {error}") from error
    if done.returncode != 0:
        reason = one_line(done.stderr.decode(errors="replace")) or "openssl refuses it"
        raise RemoteError(f"{key}: no private RSA key: {reason}")
    return done.stdout
