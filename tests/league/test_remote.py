"""Teams, automatic referees and remote controls talk to the game controller, signed where it asks for it."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from robobt.league.remote import (
    AutoRefConnection,
    RemoteControl,
    RemoteError,
    TeamConnection,
    as_signed,
    sign,
)
from robobt.league.wire.gameevents import write_event
from robobt.league.wire.messages import (
    AutoRefRegistration,
    AutoRefToController,
    ControllerReply,
    ControllerToAutoRef,
    ControllerToRemoteControl,
    ControllerToTeam,
    RemoteControlRegistration,
    RemoteControlToController,
    TeamRegistration,
    TeamToController,
)
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.world.game import Team
from tests.waiting import LIMIT

OFFICIAL = os.environ.get("ROBOBT_GAME_CONTROLLER", "")
needs_openssl = pytest.mark.skipif(shutil.which("openssl") is None, reason="there is no openssl")

KINDS: dict[str, tuple[Any, Any, Any]] = {
    "team": (TeamRegistration, TeamToController, ControllerToTeam),
    "autoref": (AutoRefRegistration, AutoRefToController, ControllerToAutoRef),
    "remote": (RemoteControlRegistration, RemoteControlToController, ControllerToRemoteControl),
}


class Listening:
    """A game controller that takes one client, and refuses what ``refuse`` gives a reason for."""

    def __init__(
        self, stack: ExitStack, kind: str, public: Path | None, refuse: Callable[[Any], str]
    ) -> None:
        self.registers, self.asks, self.answers = KINDS[kind]
        self.public, self.refuse = public, refuse
        self.heard: list[Any] = []
        self._server = stack.enter_context(socket.create_server(("127.0.0.1", 0)))
        self.port = self._server.getsockname()[1]
        self._thread = threading.Thread(target=self._serve)
        self._thread.start()
        stack.callback(self._thread.join)

    def _serve(self) -> None:
        connection, _ = self._server.accept()
        tokens = iter(f"token {number}" for number in range(1000))
        with MessageStream(connection, "the client") as stream:
            try:
                self._reply(stream, "", token := next(tokens))
                for kind in (self.registers, *[self.asks] * 1000):
                    data = stream.receive(LIMIT)
                    if data is None:
                        return
                    message = kind.FromString(data)
                    self.heard.append(message)
                    reason = self.refuse(message) or self._unsigned(message, token)
                    # After a refusal the token stays.
                    token = token if reason else next(tokens)
                    self._reply(stream, reason, token)
            except StreamError:
                return

    def _reply(self, stream: MessageStream, reason: str, token: str) -> None:
        reply = ControllerReply(status_code="REJECTED" if reason else "OK", reason=reason)
        if self.public is not None:
            reply.next_token = token
        answer = self.answers(controller_reply=reply)
        if self.answers is ControllerToRemoteControl:
            answer.state.timeouts_left = 4
        stream.send(answer.SerializeToString())

    def _unsigned(self, message: Any, token: str) -> str:
        if self.public is None:
            return ""
        if not message.HasField("signature"):
            return "Missing signature"
        if message.signature.token != token:
            return "invalid token"
        signature = message.signature.pkcs1v15
        message.signature.pkcs1v15 = b""
        return "" if verified(message.SerializeToString(), signature, self.public) else "Invalid signature"


def verified(data: bytes, signature: bytes, public: Path) -> bool:
    file = public.with_suffix(".sig")
    file.write_bytes(signature)
    command = ["openssl", "dgst", "-sha256", "-verify", str(public), "-signature", str(file)]
    return subprocess.run(command, input=data, capture_output=True, check=False).returncode == 0


@pytest.fixture
def listen() -> Iterator[Callable[..., Listening]]:
    with ExitStack() as stack:

        def listening(
            kind: str, public: Path | None = None, refuse: Callable[[Any], str] = lambda _: ""
        ) -> Listening:
            return Listening(stack, kind, public, refuse)

        yield listening


@pytest.fixture(scope="module")
def keys(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A private key and its public one."""
    folder = tmp_path_factory.mktemp("keys")
    private, public = folder / "key.pem", folder / "key.pub.pem"
    subprocess.run(["openssl", "genrsa", "-out", private, "2048"], check=True, capture_output=True)
    extract = ["openssl", "rsa", "-in", private, "-pubout", "-out", public]
    subprocess.run(extract, check=True, capture_output=True)
    return private, public


def test_a_team_names_its_keeper_asks_for_substitution_and_chooses(listen: Callable[..., Listening]) -> None:
    controller = listen("team")
    with TeamConnection("Reds", Team.YELLOW, port=controller.port) as team:
        team.keeper(4)
        team.substitute()
        team.advantage(play_on=True)
        team.ping()
    registered, *asked = controller.heard
    assert (registered.team_name, registered.team) == ("Reds", 1)
    assert [message.WhichOneof("msg") for message in asked] == [
        "desired_keeper",
        "substitute_bot",
        "advantage_choice",
        "ping",
    ]
    assert (asked[0].desired_keeper, asked[1].substitute_bot, asked[2].advantage_choice) == (4, True, 1)
    assert not any(message.HasField("signature") for message in controller.heard)


def test_an_automatic_referee_reports_events(listen: Callable[..., Listening]) -> None:
    controller = listen("autoref")
    with AutoRefConnection("mine", port=controller.port) as referee:
        referee.report(RefereeEvent(2.0, EventKind.BALL_LEFT_FIELD_TOUCH_LINE, Team.BLUE, x=1.0), 1000.0)
    event = controller.heard[1].game_event
    assert controller.heard[0].identifier == "mine"
    assert (list(event.origin), event.created_timestamp) == (["mine"], 1_002_000_000)
    assert event.ball_left_field_touch_line.location.x == 1.0


def test_a_remote_control_asks_and_is_told_the_teams_state(listen: Callable[..., Listening]) -> None:
    controller = listen("remote")
    with RemoteControl(Team.BLUE, port=controller.port) as remote:
        assert remote.state().timeouts_left == 4
        for ask in (remote.substitute, remote.timeout, remote.forced_timeout):
            ask(False)
        for ask in (remote.end_timeout, remote.challenge, remote.give_up_placement):
            ask()
        remote.keeper(2)
    registered, *asked = controller.heard
    assert registered.team == 2
    requests = [message.request for message in asked if message.WhichOneof("msg") == "request"]
    assert requests == [1, 3, 2, 4]
    assert [message.WhichOneof("msg") for message in asked[1:4]] == [
        "request_robot_substitution",
        "request_timeout",
        "request_emergency_stop",
    ]


@needs_openssl
def test_every_message_is_signed_with_the_newest_token(
    listen: Callable[..., Listening], keys: tuple[Path, Path]
) -> None:
    private, public = keys
    controller = listen("team", public)
    with TeamConnection("Reds", port=controller.port, key=private) as team:
        team.keeper(4)
        team.ping()
    assert [message.signature.token for message in controller.heard] == ["token 0", "token 1", "token 2"]


def test_a_signature_is_of_the_bytes_in_the_controllers_order() -> None:
    event = RefereeEvent(0.0, EventKind.BALL_LEFT_FIELD_TOUCH_LINE, Team.BLUE, x=1.0, y=2.0)
    message = AutoRefToController(game_event=write_event(event, 0.0, "me"))
    message.signature.token, message.signature.pkcs1v15 = "t", b""
    written = as_signed(message)
    assert AutoRefToController.FromString(written) == message
    # Type (40), origin (41) and time (49) come before what happened (6).
    assert written.index(b"\xc0\x02") < written.index(b"\xca\x02") < written.rindex(b"\x32")


@needs_openssl
def test_a_refused_request_is_an_error_with_the_reason_and_the_next_one_still_works(
    listen: Callable[..., Listening], keys: tuple[Path, Path]
) -> None:
    private, public = keys

    def refuse(message: Any) -> str:
        return (
            "Can not change keeper"
            if message.DESCRIPTOR.name.startswith("TeamTo")
            and (message.WhichOneof("msg") == "desired_keeper")
            else ""
        )

    controller = listen("team", public, refuse)
    with TeamConnection("Reds", port=controller.port, key=private) as team:
        with pytest.raises(RemoteError, match="refuses: Can not change keeper"):
            team.keeper(4)
        team.ping()


@needs_openssl
def test_without_its_key_a_known_team_is_refused(
    listen: Callable[..., Listening], keys: tuple[Path, Path]
) -> None:
    with pytest.raises(RemoteError, match="refuses: Missing signature"):
        TeamConnection("Reds", port=listen("team", keys[1]).port)


def test_a_controller_that_is_not_there_is_named() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    with pytest.raises(RemoteError, match=f"127.0.0.1:{port} cannot be reached"):
        RemoteControl(Team.BLUE, port=port)


@needs_openssl
def test_a_file_that_is_no_key_is_named(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.pem"
    wrong.write_text("nothing")
    with pytest.raises(RemoteError, match=r"wrong\.pem: no private RSA key"):
        sign(b"data", wrong)


@pytest.mark.slow
@pytest.mark.skipif(not OFFICIAL, reason="ROBOBT_GAME_CONTROLLER does not name the official program")
def test_the_official_controller_understands_all_of_it(tmp_path: Path, keys: tuple[Path, Path]) -> None:
    config = tmp_path / "config"
    config.mkdir()
    (config / "ssl-game-controller.yaml").write_text('network:\n  publish-address: ""\n')
    trusted = {"team": "Unknown", "auto_ref": "mine", "remote-control": "BLUE"}
    for folder, name in trusted.items():
        place = config / "trusted_keys" / folder
        place.mkdir(parents=True)
        (place / f"{name}.pub.pem").write_bytes(keys[1].read_bytes())
    ports = []
    for _ in range(5):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            ports.append(free.getsockname()[1])
    names = ("address", "ciAddress", "autorefAddress", "teamAddress", "remoteControlAddress")
    flags = [it for name, port in zip(names, ports, strict=True) for it in (f"-{name}", f"127.0.0.1:{port}")]
    started = [OFFICIAL, "-backendOnly", *flags]
    with subprocess.Popen(started, cwd=tmp_path, stderr=subprocess.DEVNULL) as process:
        try:
            end = time.monotonic() + LIMIT
            while True:
                try:
                    socket.create_connection(("127.0.0.1", ports[4])).close()
                    break
                except OSError:
                    assert time.monotonic() < end
                    time.sleep(0.05)
            with RemoteControl(Team.BLUE, port=ports[4], key=keys[0]) as remote:
                assert remote.keeper(5).keeper_id in (0, 5)
                remote.challenge()
                remote.timeout()
                time.sleep(0.2)
                state = remote.state()
                assert state.keeper_id == 5
                asks_for_timeout = 3
                assert asks_for_timeout in state.active_requests
                with pytest.raises(RemoteError, match="refuses"):
                    remote.end_timeout()
            with AutoRefConnection("mine", port=ports[2], key=keys[0]) as referee:
                referee.report(RefereeEvent(1.0, EventKind.BALL_LEFT_FIELD_GOAL_LINE, Team.BLUE), time.time())
            with TeamConnection("Unknown", Team.YELLOW, port=ports[3], key=keys[0]) as team:
                team.keeper(3)
                team.substitute()
                team.advantage(play_on=True)
                team.ping()
            with pytest.raises(RemoteError, match="refuses"):
                TeamConnection("Nobody", port=ports[3])
            with pytest.raises(RemoteError, match="signature"):
                AutoRefConnection("mine", port=ports[2])
        finally:
            process.terminate()
