"""Layers in a real browser: what skills draw is shown while it is looked at, whatever they draw."""

from collections.abc import Iterator
from math import nan
from pathlib import Path

import pytest

from robobt.live.replay_html import write_html
from robobt.match.recording.reader import parse_recording
from robobt.match.scenario.scenario import load_scenario
from robobt.plays import PLAYS
from robobt.skills.base import Skill
from robobt.tree import Status
from tests.live.chromium import Page
from tests.live.playing import Session, playing
from tests.live.test_server import get
from tests.waiting import soon

pytestmark = pytest.mark.integration

EVIL = "<img src=x onerror=alert(1)>"
BOXES = "return [...document.querySelectorAll('.choices input')].map(box => box.name)"
CLICK = "document.querySelector(`.choices input[name=${JSON.stringify(arguments[0])}]`).click()"
SHOWN = """const { match, state } = window.robobt, robot = match.robots[0], drawn = robot.drawn.values;
return drawn.length ? JSON.parse(drawn[drawn.length - 1]).length : 0"""


class Scribble(Skill):
    """Draws more than anybody can see, and what nobody can."""

    def on_running(self) -> Status:
        for i in range(2000):
            self.draw.line(EVIL, (0.0, 0.0), (1.0, 0.001 * i + 0.01 * self.frame.time))
        self.draw.text("words", (nan, 0.0), EVIL)
        self.draw.text("words", (0.5, 0.5), EVIL)
        self.draw.number("words", EVIL, self.frame.time)
        return self.run(EVIL)


@PLAYS.register("scribble")
def scribble() -> Scribble:
    """Draw."""
    return Scribble()


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    scenario = load_scenario("three_v_three").with_robot("blue 0", play="scribble")
    with playing(scenario) as session:
        yield session


def test_layers_are_drawn_as_long_as_they_are_looked_at(page: Page, session: Session, tmp_path: Path) -> None:
    page.open(session.server.url)
    page.wait(f"{BOXES}.length > 6")
    assert {"goal line", "paths", "targets", EVIL, "words"} <= {*page.js(BOXES)}
    assert page.js(SHOWN) == 0
    page.js(CLICK, EVIL)
    page.wait(SHOWN)
    assert page.js(SHOWN) <= 200
    page.js(CLICK, EVIL)
    page.js(CLICK, "words")
    page.wait("return window.robobt.match.robots[0].numbers.size === 1")
    page.wait(f"const n = (() => {{ {SHOWN} }})(); return n === 1")
    page.js(CLICK, "words")
    soon(lambda: session.server.layers == frozenset())
    page.wait(f"const n = (() => {{ {SHOWN} }})(); return n === 0")
    _, _, body = get(session, "recording.robobt.arrows")
    saved = parse_recording(body, tmp_path)
    assert {shape[0] for _, drawn in saved.drawn["blue 0"] for shape in drawn} == {EVIL, "words"}
    write_html(saved, tmp_path / "saved.html")
    page.open((tmp_path / "saved.html").as_uri())
    assert EVIL in page.js(BOXES)
    assert page.js("return document.querySelectorAll('img').length") == 0


def test_a_viewer_that_leaves_no_longer_looks(page: Page, session: Session) -> None:
    page.open(session.server.url)
    page.wait(f"{BOXES}.length > 6")
    page.js(CLICK, "paths")
    soon(lambda: session.server.layers == {"paths"})
    page.open("about:blank")
    soon(lambda: session.server.layers == frozenset())
