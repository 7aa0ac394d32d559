"""A person drives a robot in the live page, in a real browser."""

import threading
from collections.abc import Iterator
from itertools import groupby
from math import hypot
from operator import itemgetter
from time import monotonic

import pytest
from selenium.webdriver.common.action_chains import ActionChains

from robobt.live.messages import Pause
from robobt.match.scenario.scenario import Scenario, load_scenario
from tests.live.chromium import Page
from tests.live.human import GAMEPAD, PLAYER
from tests.live.playing import Session, playing
from tests.waiting import soon

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    start = {"position": (1.0, 0.5), "heading": 0.0}
    return load_scenario("table4_trial1_own").with_robot("blue 0", start=start, limits={"max_speed": 1.5})


@pytest.fixture(scope="module")
def session(scenario: Scenario) -> Iterator[Session]:
    ball = scenario.ball.model_copy(update={"position": (2.0, 0.0)})
    with playing(scenario.model_copy(update={"ball": ball}).lasting(60.0), paused=True) as session:
        yield session


@pytest.fixture
def driven(page: Page, session: Session) -> Iterator[Page]:
    """A page that drives the only robot of a match that goes on."""
    session.act(Pause(do="pause", on=True))
    page.steer(session.server.url)
    page.begin_again()
    page.button("Drive").click()
    page.wait("return document.querySelector('.driving button').textContent === 'Let go'")
    session.act(Pause(do="pause", on=False))
    soon(lambda: session.ticks > 3)
    yield page
    page.js("clearInterval(window.person)")


def speed(session: Session) -> float:
    return session.match.world.truth().own[0].speed


def test_keys_drive_the_robot_and_letting_go_stops_it(driven: Page, session: Session) -> None:
    ActionChains(driven.driver).key_down("w").perform()
    soon(lambda: session.match.world.truth().own[0].vy > 0.4)
    ActionChains(driven.driver).key_up("w").key_down("q").perform()
    soon(lambda: session.match.world.truth().own[0].omega > 0.5)
    ActionChains(driven.driver).key_up("q").perform()
    soon(lambda: speed(session) < 0.05)
    assert session.match.players[0].driver is not None


def test_a_key_is_sent_at_once(driven: Page, session: Session) -> None:
    def measured(times: int) -> list[float]:
        for key in "wasd" * 3:
            ActionChains(driven.driver).key_down(key).key_up(key).perform()
        delays = driven.js("return window.robobt.measured.delays")
        assert len(delays) == 12 * times
        return sorted(delays[-12:])

    # A busy machine delays some of them, or most for a while; a page that waits for its beat always most.
    assert any(measured(times)[3] < 50.0 for times in range(1, 6))


def test_a_page_that_stalls_stops_its_robot(driven: Page, session: Session) -> None:
    ActionChains(driven.driver).key_down("w").perform()
    soon(lambda: speed(session) > 0.5)
    driver = session.match.players[0].driver
    assert driver is not None
    looks: list[tuple[float, bool]] = []
    watched = threading.Event()

    def watch() -> None:
        while not watched.wait(0.02):
            looks.append((monotonic(), driver.told))  # type: ignore[attr-defined]

    watching = threading.Thread(target=watch)
    watching.start()
    # The page hangs: no command comes, and none of its release.
    driven.js("setTimeout(() => { const end = Date.now() + 1500; while (Date.now() < end); }, 0)")

    def longest() -> float:
        silences = [[time for time, _ in same] for told, same in groupby([*looks], itemgetter(1)) if not told]
        return max([silence[-1] - silence[0] for silence in silences], default=0.0)

    try:
        soon(lambda: longest() > 0.6)
    finally:
        watched.set()
        watching.join()
    ActionChains(driven.driver).key_up("w").perform()
    soon(lambda: speed(session) < 0.1)


def test_a_page_that_goes_stops_its_robot(driven: Page, session: Session) -> None:
    ActionChains(driven.driver).key_down("d").perform()
    soon(lambda: speed(session) > 0.5)
    driven.open("about:blank")
    soon(lambda: speed(session) < 0.1)
    ActionChains(driven.driver).key_up("d").perform()


def test_a_page_that_loses_the_focus_stops_its_robot(driven: Page, session: Session) -> None:
    ActionChains(driven.driver).key_down("d").perform()
    soon(lambda: speed(session) > 0.5)
    driven.js("window.dispatchEvent(new Event('blur'))")
    soon(lambda: speed(session) < 0.1)
    ActionChains(driven.driver).key_up("d").perform()


def test_a_game_controller_scores(driven: Page, session: Session) -> None:
    driven.js(GAMEPAD)
    driven.js(PLAYER)
    soon(lambda: session.match.outcome)
    assert session.match.outcome == "goal_blue"
    driven.wait("return document.querySelector('#score').textContent === '1:0'")


def test_the_tree_drives_again_when_the_robot_is_let_go(driven: Page, session: Session) -> None:
    driven.button("Let go").click()
    soon(lambda: session.match.players[0].driver is None)
    start = session.match.world.truth().own[0].position
    soon(lambda: hypot(session.match.world.truth().own[0].x - start[0], speed(session)) > 0.3)
