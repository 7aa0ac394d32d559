"""Whatever a page sends: it is read or refused, and the match goes on."""

import json
import random
import re
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from math import nan
from pathlib import Path
from time import perf_counter
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed

from robobt.live.audience import problem_with
from robobt.live.hands import Hands
from robobt.live.messages import FORMS as FORMS_BY_NAME
from robobt.live.messages import MOST_MESSAGE_BYTES, MOST_REFUSED, Message, read
from robobt.live.server import Server
from robobt.match import MatchLoop, load_scenario
from robobt.plays import PLAYS
from robobt.worlds import sim_world
from tests.live.playing import Client, playing
from tests.waiting import soon

FORMS: list[dict[str, Any]] = [
    {"do": "pause", "on": True},
    {"do": "step", "ticks": 3},
    {"do": "speed", "factor": 0.5},
    {"do": "reset", "next": False},
    {"do": "seek", "time": 3.0},
    {"do": "steer"},
    {"do": "past"},
    {"do": "layers", "shown": ["paths", "targets"]},
    {"do": "ball", "x": 1.0, "y": -0.5, "vx": 2.0, "vy": 0.0, "held": False},
    {"do": "robot", "robot": "blue 1", "x": 1.0, "y": 0.5, "heading": 1.0, "held": True},
    {"do": "off", "robot": "yellow 1"},
    {"do": "order", "order": "stop", "team": None},
    {"do": "order", "order": "free kick", "team": "yellow"},
    {"do": "form", "robot": "blue 1", "path": "field player/by the rules"},
    {
        "do": "play",
        "robot": "blue 1",
        "play": "field_player",
        "params": {"rater": "open_angle"},
        "team": True,
    },
    {"do": "skill", "robot": "blue 1", "path": "field player", "params": {"margin": 0.2}},
    {"do": "situation"},
    {"do": "take", "robot": "blue 2"},
    {"do": "release"},
    {"do": "rest"},
    {
        "do": "drive",
        "at": 3.0,
        "vx": 0.5,
        "vy": -1.0,
        "omega": 0.1,
        "frame": "field",
        "kick": 3.0,
        "assist": True,
    },
]
ABSURD: list[Any] = [
    *(nan, 1e308, -1e308, -0.0, 2**70, -1, True, None, "", "blue 99", "blue -1", "yellow 0", "\ud800", "\0"),
    *("<img src=x onerror=alert(1)>", "../../etc/passwd", "x" * 5000, [], {}, [[]] * 60, {"": {"": [None]}}),
]


def hostile(seed: int) -> Iterator[str | bytes]:
    """Messages without end like those of a page, with other values, cut, spoiled or nested."""
    rng = random.Random(seed)
    while True:
        message = dict(rng.choice(FORMS))
        for _ in range(rng.choice((0, 1, 1, 2, 5))):
            _change(message, rng)
        text = json.dumps(message, ensure_ascii=rng.random() < 0.5)
        data = text.encode("utf-8", "replace")
        kind = rng.random()
        if kind < 0.3:
            spoiled = bytearray(data)
            for _ in range(rng.choice((1, 2, 9))):
                spoiled[rng.randrange(len(spoiled))] ^= 1 << rng.randrange(8)
            yield bytes(spoiled)
        elif kind < 0.4:
            yield data[: rng.randrange(len(data))]
        elif kind < 0.45:
            yield b"[" * rng.randrange(3000) + data
        else:
            yield data.decode() if rng.random() < 0.8 else data


def _change(message: dict[str, Any], rng: random.Random) -> None:
    name = rng.choice([*message, "more"])
    others = [other[key] for other in FORMS for key in other if key == name]
    value = rng.choice(ABSURD if rng.random() < 0.6 or not others else others)
    if name == "play" and rng.random() < 0.8:
        value = rng.choice([*PLAYS])
    if name == "params" and isinstance(value, dict):
        value = {
            **value,
            rng.choice(("rater", "policy", "speed", "margin", "team", "without")): rng.choice(ABSURD),
        }
    message[name] = value


@pytest.mark.parametrize("count", [3000, pytest.param(100_000, marks=pytest.mark.slow)])
def test_whatever_is_sent_is_a_message_or_none(count: int) -> None:
    found: Counter[str] = Counter()
    for data, _ in zip(hostile(1), range(count), strict=False):
        message = read(data)
        found["none" if message is None else message.do] += 1
        assert message is None or len(data) <= MOST_MESSAGE_BYTES
    print(dict(found))
    assert found["none"] > count / 3
    assert len(found) > 15


def test_whoever_sends_no_message_is_told_what_there_is() -> None:
    said = problem_with('{"do": "dance"}')
    assert said.startswith('A message is a JSON object whose "do" is one of: pause, step, speed,')
    assert problem_with("{") == problem_with("[]") == problem_with('{"on": true}') == said
    assert "4096 bytes" in problem_with("x" * 5000)
    refused = [data for data, _ in zip(hostile(4), range(1000), strict=False) if read(data) is None]
    told = [problem_with(data) for data in refused]
    assert max(map(len, told)) < 500
    assert not [line for line in told if "something else" in line or "nput should" in line]


@pytest.mark.parametrize(
    ("message", "said"),
    [
        ({"do": "pause"}, "pause: on is missing. The message takes: on."),
        ({"do": "rest", "now": 1}, "rest: it has no now. The message takes: nothing."),
        ({"do": "speed", "factor": 90}, "speed: factor must be at most 20, not 90."),
        ({"do": "ball", "x": "left", "y": 0}, "ball: x must be a number, not 'left'."),
        ({"do": "ball", "x": -21, "y": 0}, "ball: x must be at least -20, not -21."),
        ({"do": "take", "robot": "green 1"}, 'take: robot must be a robot, such as "blue 1", not'),
        ({"do": "step", "ticks": 0.5}, "step: ticks must be a whole number, not 0.5."),
        ({"do": "pause", "on": 3}, "pause: on must be true or false, not 3."),
        ({"do": "layers", "shown": ["x" * 41]}, "layers: shown.0 must be at most 40 characters"),
        ({"do": "order", "order": "run"}, "order: order must be 'halt', "),
    ],
)
def test_a_message_is_refused_by_field_what_it_may_be_and_what_it_is(message: object, said: str) -> None:
    assert problem_with(json.dumps(message)).startswith(said)


def test_the_page_of_the_docs_lists_every_message_and_its_fields() -> None:
    page = (Path(__file__).parents[2] / "docs" / "live.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([a-z]+)` \|([^|]*)\|", page, re.MULTILINE)
    listed = {do: set(re.findall(r"`([a-z]+)", taken)) for do, taken in rows if do in FORMS_BY_NAME}
    assert listed == {do: {*form.model_fields} - {"do"} for do, form in FORMS_BY_NAME.items()}


@pytest.mark.parametrize("count", [60, pytest.param(3000, marks=pytest.mark.slow)])
def test_whatever_is_asked_for_the_match_goes_on(count: int) -> None:
    server = Server()
    with MatchLoop(load_scenario("three_v_three").lasting(1e4), 3, sim_world) as match:
        hands = Hands(match, server, perf_counter)
        messages: Iterator[Message] = filter(None, map(read, hostile(2)))
        for number, message in zip(range(count), messages, strict=False):
            if message.do not in ("steer", "past", "layers"):
                hands.do(message, 0.1 * number, 0.1 * number)  # type: ignore[arg-type]
            hands.hold(0.1 * number)
            assert match.tick()
        assert len(match.players) == 6


@pytest.mark.slow
@pytest.mark.integration
def test_thousands_of_hostile_messages_over_the_network() -> None:
    messages, sent = hostile(3), 0
    with playing("three_v_three") as session:
        while sum(session.server.refused.values()) < 5000:
            with Client(session.server.url) as client, suppress(ConnectionClosed):
                for _ in range(20 * MOST_REFUSED):
                    client.socket.send(next(messages))
                    sent += 1
        ticks = session.ticks
        with Client(session.server.url) as client:
            client.socket.send(json.dumps({"do": "steer"}))
            client.socket.send(json.dumps({"do": "reset"}))
            client.socket.send(json.dumps({"do": "pause", "on": False}))
            soon(lambda: 0 < session.ticks < ticks or session.ticks > ticks + 10)
    print(sent, session.server.refused)
