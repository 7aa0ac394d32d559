"""Who is let in, what is refused, and that the match goes on meanwhile."""

import http.client
import json
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from time import sleep

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from robobt.live.messages import MOST_REFUSED, Allowance, read
from robobt.match.recording.reader import parse_recording
from tests.live.playing import Client, Session, playing
from tests.waiting import LIMIT, soon

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    with playing("striker_vs_goalkeeper", speed=1.0) as session:
        yield session


def get(
    session: Session, path: str, method: str = "GET", body: bytes = b"", **headers: str
) -> tuple[int, dict[str, str], bytes]:
    """Ask for a path behind the token, or an absolute one."""
    _, _, address, token, _ = session.server.url.split("/")
    connection = http.client.HTTPConnection(address, timeout=LIMIT)
    place = path if path.startswith("/") else f"/{token}/{path}"
    connection.request(method, place, body or None, headers=headers)
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, dict(answer.getheaders()), body


def test_the_page_comes_with_a_policy_that_lets_no_script_in_but_its_files(session: Session) -> None:
    status, headers, body = get(session, "")
    assert status == 200
    policy = headers["Content-Security-Policy"]
    assert "default-src 'none'" in policy
    assert "script-src 'self';" in policy
    assert "unsafe" not in policy
    assert b"<script>" not in body
    assert b"style=" not in body
    assert headers["X-Content-Type-Options"] == "nosniff"


def test_files_of_the_page_are_served_and_no_others(session: Session) -> None:
    assert get(session, "live.js")[0] == 200
    for name in ("../server.py", "server.py", "%2e%2e/server.py", "viewer.html", "page/live.js", "live.js/"):
        assert get(session, name)[0] == 404


def ask(session: Session, *pieces: bytes) -> bytes:
    """Send bytes as they are, a piece at a time, and return all that comes back."""
    host, _, port = session.server.url.split("/")[2].partition(":")
    with socket.create_connection((host, int(port)), timeout=LIMIT) as connection:
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for piece in pieces:
            connection.sendall(piece)
        return b"".join(iter(lambda: connection.recv(65536), b""))


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "get"])
@pytest.mark.parametrize("body", [b"", b"x" * 100_000])
def test_methods_that_would_change_something_are_not_allowed(
    session: Session, method: str, body: bytes
) -> None:
    for name in ("", "live.js", "nothing", "socket"):
        status, headers, _ = get(session, name, method, body)
        assert status == 405
        assert headers["Allow"] == "GET, HEAD"


def test_a_method_that_comes_in_pieces_or_with_a_chunked_body_is_not_allowed(session: Session) -> None:
    head = b"OST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n"
    assert ask(session, b"P", head).startswith(b"HTTP/1.1 405 ")


def test_head_tells_what_get_would_without_the_content(session: Session) -> None:
    got, head = get(session, "live.js"), get(session, "live.js", "HEAD")
    assert head == (200, got[1], b"")
    path = "/" + session.server.url.split("/", 3)[3] + "live.js"
    host = session.server.url.split("/")[2]
    assert ask(session, f"HEAD {path} HTTP/1.1\r\nHost: {host}\r\n\r\n".encode()).endswith(b"\r\n\r\n")


def test_without_the_token_there_is_nothing(session: Session) -> None:
    before = session.server.refused["token"]
    for path in ("/", "/socket", "/wrong/", "/wrong/live.js", "/wrong/recording.robobt.arrows"):
        assert get(session, path)[0] == 403
    assert session.server.refused["token"] == before + 5


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1:1", "127.0.0.1"])
def test_a_name_that_was_made_to_lead_here_is_refused(session: Session, host: str) -> None:
    assert get(session, "", Host=host)[0] == 403
    assert session.server.refused["host"] >= 1


@pytest.mark.parametrize("origin", [None, "http://evil.example", "null", "https://127.0.0.1"])
def test_a_page_from_elsewhere_cannot_connect(session: Session, origin: str | None) -> None:
    before = session.server.refused["origin"]
    address = session.server.url.replace("http", "ws") + "socket"
    with pytest.raises(InvalidStatus, match="403"), connect(address, origin=origin):  # type: ignore[arg-type]
        pass
    assert session.server.refused["origin"] == before + 1


def test_messages_that_are_none_are_counted_and_end_the_connection(session: Session) -> None:
    before, ticks = session.server.refused["no message"], session.ticks
    none = ("{", '{"do":"fly"}', '{"do":"speed","factor":"fast"}', "[]", "")
    with Client(session.server.url) as client, suppress(ConnectionClosed):
        for i in range(100_000):
            client.socket.send(none[i % 5])
        pytest.fail("all of them were taken")
    assert session.server.refused["no message"] - before == MOST_REFUSED
    soon(lambda: session.ticks > ticks)


def test_a_message_of_64_megabytes_ends_the_connection(session: Session) -> None:
    ticks = session.ticks
    with Client(session.server.url) as client, suppress(ConnectionClosed, OSError):
        client.socket.send("x" * 2**26)
        while True:
            client.socket.recv()
    soon(lambda: session.server.refused["too long"])
    soon(lambda: session.ticks > ticks)


@pytest.mark.parametrize(
    "message",
    [
        {"do": "speed", "factor": 1e9},
        {"do": "speed", "factor": 0},
        {"do": "step", "ticks": 10**9},
        {"do": "pause", "on": True, "more": 1},
        {"do": "pause"},
        {"do": ["pause"]},
    ],
)
def test_values_out_of_range_are_no_messages(message: object) -> None:
    assert read(json.dumps(message)) is None
    assert read('{"do":"speed","factor":NaN}') is None
    assert read(json.dumps({"do": "pause", "on": True})) is not None


def test_a_page_may_send_much_for_a_moment_and_less_for_long() -> None:
    allowance = Allowance(0.0)
    assert sum(allowance.take(0.0) for _ in range(1000)) == 400
    assert sum(allowance.take(1.0) for _ in range(1000)) == 200


def test_one_viewer_steers_and_another_can_take_over(session: Session) -> None:
    with Client(session.server.url) as first, Client(session.server.url) as second:
        first.read(lambda it: it.state.get("viewers") == 2)
        second.read(lambda it: it.state.get("viewers") == 2)
        assert (first.state["steers"], second.state["steers"]) == (True, False)
        second.ask(do="pause", on=True)
        soon(lambda: session.server.refused["not steering"])
        second.ask(do="steer")
        second.read(lambda it: it.state["steers"])
        first.read(lambda it: not it.state["steers"])
        second.ask(do="pause", on=True)
        first.read(lambda it: it.state["paused"])
        second.ask(do="pause", on=False)
        first.read(lambda it: not it.state["paused"])
    with Client(session.server.url) as last:
        last.read(lambda it: it.state.get("steers"))


def test_a_match_is_paused_stepped_and_started_anew(session: Session) -> None:
    with Client(session.server.url) as client:
        client.read(lambda it: it.state.get("steers"))
        client.ask(do="reset")
        client.read(lambda it: it.hello["trial"] > 0)
        client.ask(do="pause", on=True)
        client.read(lambda it: it.state.get("paused"))
        sleep(0.2)
        paused = session.ticks
        sleep(0.2)
        assert session.ticks == paused
        client.ask(do="step", ticks=3)
        soon(lambda: session.ticks == paused + 3)
        client.ask(do="reset", next=False)
        soon(lambda: session.ticks == 0)
        assert session.match.seed == session.matches[-2].seed
        client.ask(do="pause", on=False)
        soon(lambda: session.ticks > 5)


def test_what_was_seen_is_saved_as_a_recording(session: Session, tmp_path: Path) -> None:
    with Client(session.server.url) as client:
        client.read(lambda it: len(it.chunks) > 3)
        status, headers, body = get(session, "recording.robobt.arrows")
    assert status == 200
    assert "attachment" in headers["Content-Disposition"]
    recording = parse_recording(body, tmp_path)
    assert recording.header.scenario == "striker_vs_goalkeeper"
    assert len(recording) > 3
