"""What people do with the live page, in a real browser."""

from collections.abc import Iterator
from pathlib import Path
from time import monotonic, sleep

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from robobt.live.messages import Pause
from robobt.live.replay_html import write_html
from robobt.live.server import Server
from robobt.live.session import Live
from robobt.match import MatchLoop, load_scenario
from robobt.match.recording.reader import parse_recording
from robobt.worlds import sim_world
from tests.live.chromium import Page
from tests.live.playing import Session, playing
from tests.live.test_server import get
from tests.waiting import soon

pytestmark = pytest.mark.integration

SHOWN = "return window.robobt && window.robobt.match.frames"
ROWS = """const { match } = window.robobt;
return match.robots.map(robot => [...robot.rows.subarray(0, 4 * match.frames)])"""
TIME = "return window.robobt.state.time"


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    with playing("striker_vs_goalkeeper") as session:
        yield session


@pytest.fixture
def live(page: Page, session: Session) -> Page:
    """The live page with a match that has just begun."""
    session.act(Pause(do="pause", on=False))
    page.steer(session.server.url)
    page.begin_again()
    page.wait("return window.robobt.match.frames > 2")
    return page


def keys(page: Page, *pressed: str) -> None:
    ActionChains(page.driver).send_keys(*pressed).perform()


def paused(page: Page, session: Session) -> int:
    """Pause the match; return how many ticks it has."""
    keys(page, " ")
    page.wait("return [...document.querySelectorAll('.chip')].some(chip => chip.textContent === 'paused')")
    return session.ticks


def test_the_page_shows_the_match_as_it_goes_on(live: Page, session: Session) -> None:
    first = live.js(TIME)
    live.wait("return window.robobt.state.time > arguments[0] + .3", first)
    assert live.find("h1").text == "striker_vs_goalkeeper"
    assert len(live.driver.find_elements("css selector", "#picker .pick")) == 2
    live.wait("return document.querySelector('#tree .row[data-s=R]') !== null")


def test_the_chosen_robots_delay_is_shown_where_it_is_measured(live: Page, session: Session) -> None:
    name = live.js("return window.robobt.match.robots[0].name")
    live.js("document.querySelector('.pick').click()")
    shown = "return [document.getElementById('delay').hidden, document.getElementById('f-delay').textContent]"
    assert live.js(shown)[0]
    session.server.tell(delays={name: [0.1, 0.0042]})
    live.wait(f"const [hidden, text] = (() => {{ {shown} }})(); return !hidden && text === '100 ± 4 ms'")
    session.server.tell(delays={name: None})
    live.wait(f"const [hidden, text] = (() => {{ {shown} }})(); return !hidden && text === 'not seen enough'")
    session.server.tell(delays=None)


def test_a_page_says_that_nothing_is_played_yet(page: Page) -> None:
    with Server() as server:
        page.open(server.url)
        page.wait("return document.querySelector('.told').textContent.startsWith('Nothing is played yet')")
        with MatchLoop(load_scenario("striker_vs_goalkeeper"), 3, sim_world) as match:
            Live(server).begin(match)
            page.wait(
                "return window.robobt.match.robots && document.querySelector('.told').textContent === ''"
            )


def test_space_pauses_the_match_and_an_arrow_plays_one_tick(live: Page, session: Session) -> None:
    ticks = paused(live, session)
    keys(live, Keys.ARROW_RIGHT)
    soon(lambda: session.ticks == ticks + 1)
    shown = session.match.scenario.period * ticks
    live.wait("return Math.abs(window.robobt.state.time - arguments[0]) < .002", shown)
    keys(live, " ")
    soon(lambda: session.ticks > ticks + 3)


def test_speed_is_that_of_the_match(live: Page, session: Session) -> None:
    slow, _, usual, *_ = live.driver.find_elements("css selector", "#speeds button")
    slow.click()
    soon(lambda: slow.get_attribute("aria-pressed") == "true")
    ticks, began = session.ticks, monotonic()
    sleep(0.5)
    soon(lambda: (session.ticks - ticks) * session.match.scenario.period > 0.05)
    played = (session.ticks - ticks) * session.match.scenario.period
    assert played < 0.5 * (monotonic() - began)
    usual.click()
    soon(lambda: usual.get_attribute("aria-pressed") == "true")


def test_one_goes_back_while_the_match_goes_on_and_forward_to_now(live: Page, session: Session) -> None:
    live.wait("return window.robobt.match.frames > 20")
    keys(live, Keys.HOME)
    assert live.js(TIME) == pytest.approx(0.0, abs=0.05)
    ticks = session.ticks
    soon(lambda: session.ticks > ticks + 5)
    assert live.js(TIME) == pytest.approx(0.0, abs=0.05)
    live.button("Now").click()
    live.wait("const r = window.robobt; return r.state.time > r.match.times[r.match.frames - 1] - .2")
    assert not live.button("Now").is_displayed()


def test_a_page_that_is_loaded_anew_knows_what_was_before(live: Page, session: Session) -> None:
    live.wait("return window.robobt.match.frames > 30")
    frames = paused(live, session)
    live.driver.refresh()
    live.wait("return window.robobt && window.robobt.match.frames >= arguments[0]", frames)
    assert live.js("return window.robobt.match.times[0]") == 0.0
    live.wait("return document.querySelector('.live button[aria-pressed=true]') !== null")
    keys(live, " ")
    soon(lambda: session.ticks > frames + 3)


def test_the_recording_that_is_saved_is_replayed_as_it_was_shown(
    live: Page, session: Session, tmp_path: Path
) -> None:
    live.wait("return window.robobt.match.frames > 30")
    paused(live, session)
    shown = live.js(ROWS)
    status, _, body = get(session, "recording.robobt.arrows")
    assert status == 200
    write_html(parse_recording(body, tmp_path), tmp_path / "saved.html")
    live.open((tmp_path / "saved.html").as_uri())
    assert live.js(ROWS) == shown
    session.act(Pause(do="pause", on=False))


def test_of_two_viewers_one_steers(live: Page, session: Session) -> None:
    first = live.driver.current_window_handle
    live.driver.switch_to.new_window("tab")
    try:
        live.open(session.server.url)
        live.wait(SHOWN)
        live.wait("return document.querySelector('#head').textContent.includes('viewers')")
        ticks = session.ticks
        live.find("#speeds button").click()
        assert "Another viewer steers" in live.find(".told").text
        live.button("Steer").click()
        live.wait("return document.querySelector('.live button[aria-pressed=true]') !== null")
        paused(live, session)
        assert session.ticks >= ticks
        keys(live, " ")
    finally:
        live.driver.close()
        live.driver.switch_to.window(first)


def test_the_replay_page_plays_by_itself(page: Page, tmp_path: Path, session: Session) -> None:
    session.act(Pause(do="pause", on=False))
    soon(lambda: session.ticks > 30)
    _, _, body = get(session, "recording.robobt.arrows")
    write_html(parse_recording(body, tmp_path), tmp_path / "replay.html")
    page.open((tmp_path / "replay.html").as_uri())
    keys(page, " ")
    page.wait("return window.robobt.state.time > .2")
