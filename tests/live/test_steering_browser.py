"""What people do to the match in the live page, in a real browser."""

from collections.abc import Iterator
from math import hypot
from pathlib import Path

import pytest
from selenium.webdriver.common.actions.action_builder import ActionBuilder

from robobt.live.messages import Pause
from robobt.live.stream import Stream
from robobt.match.recording import Event
from robobt.match.recording.reader import parse_recording
from robobt.match.scenario.scenario import load_scenario
from robobt.world.game import RefereeCommand
from tests.live.chromium import Page
from tests.live.playing import Client, Session, playing
from tests.waiting import soon

pytestmark = pytest.mark.integration

PLACE = """const { match } = window.robobt, box = document.querySelector("#field").getBoundingClientRect();
const scale = box.width / (match.field.length + 2 * match.field.goal_line_margin);
return [box.x + box.width / 2 + arguments[0] * scale, box.y + box.height / 2 - arguments[1] * scale];"""
EVIL = "<img src=x onerror=alert(1)>"


@pytest.fixture(scope="module")
def session() -> Iterator[Session]:
    scenario = load_scenario("three_v_three").with_robot("blue 1", play="stand_still")
    scenario = scenario.model_copy(update={"name": EVIL})
    with playing(scenario, paused=True) as session:
        yield session


@pytest.fixture
def live(page: Page, session: Session) -> Page:
    """The live page with a paused match that this page steers."""
    session.act(Pause(do="pause", on=True))
    page.steer(session.server.url)
    page.begin_again()
    play(page, session, 3)
    return page


def play(page: Page, session: Session, ticks: int) -> None:
    """Play some ticks and see them shown."""
    before = session.ticks
    for _ in range(ticks):
        page.find("#next").click()
    soon(lambda: session.ticks == before + ticks)
    shown = session.match.scenario.period * (session.ticks - 1)
    page.wait("return window.robobt.state.time > arguments[0] - .001", shown)


def drag(page: Page, start: tuple[float, float], end: tuple[float, float], steps: int = 4) -> None:
    """Drag from one place of the field to another [m]."""
    builder = ActionBuilder(page.driver, duration=30)
    pointer = builder.pointer_action
    pointer.move_to_location(*page.js(PLACE, *start)).pointer_down()
    for step in range(1, steps + 1):
        share = step / steps
        place = [a + share * (b - a) for a, b in zip(start, end, strict=True)]
        pointer.move_to_location(*page.js(PLACE, *place))
    pointer.pointer_up()
    builder.perform()


def test_a_robot_is_dragged_and_taken_off_and_put_back(live: Page, session: Session) -> None:
    world = session.match.world
    robot = world.truth().own[1]
    drag(live, robot.position, (-2.0, 1.5))
    soon(lambda: hypot(world.truth().own[1].x + 2.0, world.truth().own[1].y - 1.5) < 0.05)
    play(live, session, 1)
    drag(live, world.truth().own[1].position, (-2.0, 3.3), 6)
    soon(lambda: len(world.truth().own) == 2)
    play(live, session, 1)
    live.find("#picker .pick.blue:nth-of-type(2)").click()
    live.button("Take off").click()
    soon(lambda: len(world.truth().own) == 3)
    play(live, session, 1)
    soon(lambda: any(event.kind == "robot moved" for event in recorded(session)))


def test_what_is_dragged_in_a_paused_match_is_drawn_at_once(live: Page, session: Session) -> None:
    ball = session.match.world.truth().ball.position
    ticks = session.ticks
    at = live.js(PLACE, -3.0, 2.0)
    pixel = """const canvas = document.querySelector('#field'), box = canvas.getBoundingClientRect();
      const share = canvas.width / box.width, [x, y] = arguments;
      const read = new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
      read.drawImage(canvas, (x - box.x) * share, (y - box.y) * share, 1, 1, 0, 0, 1, 1);
      return [...read.getImageData(0, 0, 1, 1).data];"""
    grass = live.js(pixel, *at)
    drag(live, ball, (-3.0, 2.0))
    soon(lambda: live.js(pixel, *at) != grass)
    assert session.ticks == ticks


def test_the_line_of_time_reaches_the_pause(live: Page, session: Session) -> None:
    # Events and the axis are drawn four times a second: also after the last tick before a pause.
    play(live, session, 5)
    end = session.match.scenario.period * (session.ticks - 1)
    live.wait("return Number(document.querySelector('#line').ariaValueMax) > arguments[0] - .006", end)
    same = """const track = document.querySelector('#track'), before = track.toDataURL();
      window.robobt.state.show();
      return track.toDataURL() === before;"""
    assert live.js(same)


def recorded(session: Session) -> list[Event]:
    stream = session.server.audience.stream
    assert isinstance(stream, Stream)
    return [*parse_recording(stream.recording(), Path("live")).events]


def test_a_ball_that_is_flicked_rolls(live: Page, session: Session) -> None:
    world = session.match.world
    ball = world.truth().ball
    drag(live, ball.position, (ball.x + 1.0, ball.y + 0.5), 8)
    soon(lambda: world.truth().ball.speed > 0.5)
    moving = world.truth().ball
    assert moving.vx > 0.0
    assert moving.vx / moving.vy == pytest.approx(2.0, rel=0.3)


def test_a_robot_is_given_another_play_by_the_form(live: Page, session: Session) -> None:
    live.find("#picker .pick.blue:nth-of-type(3)").click()
    live.button("Edit play").click()
    live.wait("return document.querySelector('.forms select[name=play]') !== null")
    seen = """const form = document.querySelector('.forms form').getBoundingClientRect();
      const column = document.querySelector('aside').getBoundingClientRect();
      return form.top < column.bottom && form.bottom <= column.bottom + 1;"""
    assert live.js(seen), "the form is out of sight"
    live.js("document.querySelector('.forms select[name=play]').value = 'stand_still'")
    live.button("Apply").click()
    live.wait("return document.querySelector('#who-play').textContent === 'stand_still'")
    live.wait("return window.robobt.match.robots[2].nodes.length === 1")


def test_a_parameter_of_a_skill_is_changed_by_the_form(live: Page, session: Session) -> None:
    live.find("#picker .pick.yellow").click()
    find = """const robot = window.robobt.state.robot;
const place = robot.nodes.findIndex(node => node.type === 'CoverAngle');
document.querySelectorAll('#tree .row')[place].click(); return place;"""
    place = live.js(find)
    assert place > 0
    live.button("Edit skill").click()
    field = soon(lambda: live.driver.find_elements("css selector", ".forms input[type=number]"))[0]
    name = field.get_attribute("name")
    field.clear()
    field.send_keys("0.37")
    live.button("Apply").click()
    # The form shows what was typed before the match has heard of it; a change makes another tree.
    player = session.match.players[3]
    soon(lambda: player.runner.nodes[place].parameters()[name] == 0.37)  # type: ignore[attr-defined]
    live.wait("return window.robobt.match.robots[3].nodes[arguments[0]].detail.includes('=0.37')", place)
    # Paused, the page goes on showing where the robots are.
    live.wait("return window.robobt.match.frames === 1")
    play(live, session, 2)
    assert live.js("return window.robobt.match.frames") >= 2


def test_what_is_typed_stays_whatever_the_match_tells(live: Page, session: Session) -> None:
    live.find("#picker .pick.blue").click()
    live.button("Edit play").click()
    soon(lambda: live.driver.find_elements("css selector", ".forms input[type=number]"))
    live.js("document.querySelector('.forms input[type=number]').value = '0.123'")
    session.server.say("something else")
    live.wait("return document.querySelector('.told').textContent === 'something else'")
    assert live.js("return document.querySelector('.forms input[type=number]').value") == "0.123"


def test_a_form_that_is_closed_stays_closed_until_it_is_asked_for(live: Page, session: Session) -> None:
    live.find("#picker .pick.blue").click()
    live.button("Edit play").click()
    live.wait("return document.querySelector('.forms form') !== null")
    live.button("Close").click()
    session.server.say("it goes on")
    live.wait("return document.querySelector('.told').textContent === 'it goes on'")
    assert live.js("return document.querySelector('.forms form') === null")
    live.button("Edit play").click()
    live.wait("return document.querySelector('.forms form') !== null")


def test_what_is_typed_stays_when_the_answer_to_an_earlier_value_comes(live: Page, session: Session) -> None:
    live.find("#picker .pick.blue").click()
    live.button("Edit play").click()
    soon(lambda: live.driver.find_elements("css selector", ".forms input[type=number]"))
    asked = session.server.audience.state["form"]["number"]
    live.js(
        """const input = document.querySelector('.forms input[type=number]'), form = input.form;
        input.focus(); input.value = '0.3'; form.requestSubmit(); input.value = '0.4';"""
    )
    soon(lambda: session.server.audience.state["form"]["number"] > asked)
    session.server.say("answered")
    live.wait("return document.querySelector('.told').textContent === 'answered'")
    value, focused = live.js(
        """const input = document.querySelector('.forms input[type=number]');
        return [input.value, input === document.activeElement];"""
    )
    assert (value, focused) == ("0.4", True)


def test_a_form_is_shown_to_who_asked_for_it_alone(live: Page, session: Session) -> None:
    shown = "return document.querySelector('.forms form') !== null"
    typed = "return document.querySelector('.forms input[type=number]').value"
    live.find("#picker .pick.blue").click()
    live.button("Edit play").click()
    live.wait(shown)
    live.js("document.querySelector('.forms input[type=number]').value = '0.123'")
    steers = "return document.querySelector('.live button[aria-pressed=true]') !== null"
    with Client(session.server.url) as other:
        other.ask(do="steer")
        live.wait(f"return !(() => {{ {steers} }})()")
        other.ask(do="form", robot="yellow 0")
        soon(lambda: session.server.audience.state["form"]["robot"] == "yellow 0")
        session.server.say("another form")
        live.wait("return document.querySelector('.told').textContent === 'another form'")
    live.wait(steers)
    assert live.js(typed) == "0.123"
    live.steer(session.server.url)
    assert not live.js(shown)


def test_a_wrong_value_is_told_and_changes_nothing(live: Page, session: Session) -> None:
    live.find("#picker .pick.blue").click()
    live.button("Edit play").click()
    field = soon(lambda: live.driver.find_elements("css selector", ".forms input[type=number]"))[0]
    live.js("arguments[0].value = '-1e9'", field)
    live.button("Apply").click()
    live.wait("return document.querySelector('.told').textContent !== ''")
    live.js("arguments[0].value = '0.5'", field)
    live.button("Apply").click()
    assert live.js("return document.querySelector('.told').textContent") == ""


def test_the_referee_is_told_to_stop(live: Page, session: Session) -> None:
    live.button("Force start").click()
    play(live, session, 1)
    assert session.match.game.command is RefereeCommand.FORCE_START
    live.driver.find_element("xpath", "//section[@aria-label='Steering']//button[.='Stop']").click()
    play(live, session, 1)
    assert session.match.game.command is RefereeCommand.STOP
    live.wait("return document.querySelector('#word').textContent.startsWith('Stop')")


def test_names_are_text_and_never_markup(live: Page, session: Session) -> None:
    assert live.find("h1").text == EVIL
    assert live.js("return document.querySelectorAll('img').length") == 0


def test_a_robot_is_turned_where_it_stands(live: Page, session: Session) -> None:
    world = session.match.world
    drag(live, world.truth().own[1].position, (-1.0, -1.0))
    soon(lambda: hypot(world.truth().own[1].x + 1.0, world.truth().own[1].y + 1.0) < 0.05)
    play(live, session, 1)
    before = world.truth().own[1].heading
    live.find("#picker .pick.blue:nth-of-type(2)").click()
    for _ in range(3):
        live.button("⟲ Turn").click()
        play(live, session, 1)
    assert world.truth().own[1].heading - before == pytest.approx(0.785, abs=0.15)
