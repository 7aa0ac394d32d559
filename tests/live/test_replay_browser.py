"""The replay page in a real browser: its charts, and what a game controller says."""

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.ui import Select

from robobt.live.replay_html import write_html
from robobt.match import MatchLoop, load_scenario
from robobt.match.recording import Event, Recording, load_recording
from robobt.world.game import GameState, RefereeCommand, Restart, Team, TeamStatus
from robobt.worlds import sim_world
from tests.live.chromium import Page
from tests.waiting import soon

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    path = tmp_path_factory.mktemp("chart") / "m.robobt.arrows"
    scenario = load_scenario("striker_vs_goalkeeper").lasting(6.0)
    with MatchLoop(scenario, 3, sim_world, path) as match:
        while match.tick():
            pass
    return load_recording(path)


def test_what_a_game_controller_says_is_shown(page: Page, recording: Recording, tmp_path: Path) -> None:
    status = TeamStatus(keeper=0, max_robots=5, yellow_cards=1)
    game = GameState(RefereeCommand.STOP, upcoming=RefereeCommand.PREPARE_PENALTY_YELLOW, blue=status)
    write_html(replace(recording, games=[(0, game)]), tmp_path / "m.html")
    page.open((tmp_path / "m.html").as_uri())
    said = page.find("#stage").text
    assert said == "Normal first half · next: penalty for yellow · blue: 1 yellow card, so at most 5 robots"
    assert page.find("#who-play").text == "attack_main, goalkeeper"


@pytest.fixture
def saved(page: Page, tmp_path: Path) -> Path:
    page.driver.execute_cdp_cmd(
        "Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(tmp_path)}
    )
    return tmp_path / "robobt.csv"


def test_a_window_of_a_chart_is_downloaded(
    page: Page, recording: Recording, tmp_path: Path, saved: Path
) -> None:
    write_html(recording, tmp_path / "m.html")
    page.open((tmp_path / "m.html").as_uri())
    page.button("Chart").click()
    adding = Select(page.find(".chart select"))
    more = ["blue 0 vy [m/s]", "blue 0 turning [rad/s]", "blue 0 ball contact"]
    for name in ("blue 0 x [m]", "blue 0 shot.score", *more):
        adding.select_by_visible_text(name)
    plot = page.find(".plot")
    width = plot.size["width"]
    ActionChains(page.driver).move_to_element_with_offset(plot, width // 4, 0).perform()
    shown = float(page.find(".entry b").text)
    at = int(0.75 * len(recording))
    near = recording.truth.ball[at - 10 : at + 10, 2:4]
    assert min(near[:, 0] ** 2 + near[:, 1] ** 2) ** 0.5 - 0.01 <= shown
    assert shown <= max(near[:, 0] ** 2 + near[:, 1] ** 2) ** 0.5 + 0.01
    ActionChains(page.driver).move_to_element_with_offset(
        plot, -width // 4, 0
    ).click_and_hold().move_by_offset(width // 4, 0).release().perform()
    page.find(".chart a").click()
    soon(saved.exists)
    rows = [*csv.reader(saved.read_text().splitlines())]
    assert rows[0] == ["time [s]", "ball speed [m/s]", "blue 0 x [m]", "blue 0 shot.score", *more]
    assert 0.15 < len(rows) / len(recording) < 0.35
    times = [float(row[0]) for row in rows[1:]]
    ticks = [int(abs(recording.times - time).argmin()) for time in times]
    assert ticks == [*range(ticks[0], ticks[0] + len(ticks))]
    xs = [float(row[2]) for row in rows[1:]]
    assert xs == pytest.approx(recording.truth.robots[ticks, 0, 0].tolist(), abs=6e-4)
    for column, field, close in ((4, 4, 0.25), (5, 5, 1.0)):
        misses = [
            abs(float(row[column]) - recording.truth.robots[tick, 0, field])
            for row, tick in zip(rows[1:], ticks, strict=True)
        ]
        assert sorted(misses)[int(0.95 * len(misses))] < close
    assert [float(row[6]) for row in rows[1:]] == recording.truth.contact[ticks, 0].tolist()


TREE = """const rows = [...document.querySelectorAll("#tree .row")], box = document.querySelector("#tree").getBoundingClientRect();
const active = rows.findIndex(row => row.classList.contains("active")), at = active < 0 ? null : rows[active].getBoundingClientRect();
return { shown: rows.flatMap((row, i) => row.hidden ? [] : [i]), active, seen: at !== null && at.top >= box.top && at.bottom <= box.bottom + 1,
  strip: document.querySelector("#strip").textContent, states: rows.map(row => row.dataset.s) };"""  # noqa: E501


def at_tick(page: Page, recording: Recording, tmp_path: Path, tick: int) -> dict[str, Any]:
    write_html(recording, tmp_path / "m.html")
    page.open("about:blank")
    page.open((tmp_path / "m.html").as_uri() + f"#robot=blue 0&t={recording.times[tick] + 1e-3}")
    found: dict[str, Any] = page.js(TREE)
    return found


def test_the_tree_is_open_along_the_way_to_the_active_leaf_and_folded_elsewhere(
    page: Page, recording: Recording, tmp_path: Path
) -> None:
    robot = recording.header.robots[0]
    tick = len(recording) // 2
    tree = at_tick(page, recording, tmp_path, tick)
    leaf = robot.tree[tree["active"]]
    assert recording.statuses_at(robot.id, tick)[tree["active"]] == "R"
    assert tree["seen"]
    assert tree["strip"] == f"active leaf, {leaf.name}"
    above = [place for place, node in enumerate(robot.tree) if f"{leaf.path}/".startswith(f"{node.path}/")]
    beside = [
        place
        for place, node in enumerate(robot.tree)
        if node.path.rpartition("/")[0]
        in {robot.tree[place].path for place in above if robot.tree[place].kind != "leaf"}
    ]
    assert tree["shown"] == sorted({*above, *beside})
    assert len(tree["shown"]) < len(robot.tree)
    page.button("Whole tree").click()
    assert len(page.js(TREE)["shown"]) == len(robot.tree)
    page.js("document.querySelectorAll('#tree .row')[0].click()")
    assert page.js(TREE)["strip"] == robot.tree[0].name


def test_a_condition_that_does_not_hold_is_no_failure(
    page: Page, recording: Recording, tmp_path: Path
) -> None:
    robot = recording.header.robots[0]
    tree = at_tick(page, recording, tmp_path, 3)
    failed = [place for place, letter in enumerate(recording.letters_at(robot.id, 3)) if letter == "F"]
    conditions = [place for place in failed if robot.tree[place].condition]
    actions = [place for place in failed if robot.tree[place].kind == "leaf" and place not in conditions]
    assert conditions
    assert {tree["states"][place] for place in conditions} == {"N"}
    assert all(tree["states"][place] == "F" for place in actions)


def test_a_folded_branch_tells_why_it_failed(page: Page, recording: Recording, tmp_path: Path) -> None:
    robot = recording.header.robots[0]
    names = [node.name for node in robot.tree]
    tick = next(tick for tick, letters in recording.letters[0] if letters[names.index("score")] == "F")
    at_tick(page, recording, tmp_path, tick)
    rows = "return [...document.querySelectorAll('#tree .row .say')].map(say => say.textContent)"
    said = page.js(rows)[names.index("score")]
    ends = next(
        place for place in range(names.index("score") + 1, len(names)) if robot.tree[place].depth == 1
    )
    inside = range(names.index("score") + 1, ends)
    letters = recording.letters_at(robot.id, tick)
    decided = [names[place] for place in inside if letters[place] == "F"]
    assert decided
    assert decided[-1] in said.rpartition(" · ")[2]


def test_the_tree_fills_its_column(page: Page, recording: Recording, tmp_path: Path) -> None:
    page.size(1100, 757)
    at_tick(page, recording, tmp_path, 100)
    assert page.js("return document.querySelector('#tree').getBoundingClientRect().height") > 300
    below = (
        "return innerHeight - document.querySelector('aside').lastElementChild.getBoundingClientRect().bottom"
    )
    assert page.js(below) < 40
    page.size(1400, 900)


def test_colours_and_signs_are_explained(page: Page, recording: Recording, tmp_path: Path) -> None:
    tree = at_tick(page, recording, tmp_path, 100)
    named = "return [...document.querySelectorAll('#inks span')].map(entry => entry.textContent)"
    assert recording.header.robots[0].tree[tree["active"]].name in page.js(named)
    page.js("document.querySelectorAll('#tree .row')[0].click()")
    assert set(page.js(named)) <= {"running", "success", "failure", "does not hold"}
    assert page.find("#drawn").text == ""


def test_a_free_kick_is_over_once_the_ball_is_in_play(
    page: Page, recording: Recording, tmp_path: Path
) -> None:
    waiting = GameState(
        RefereeCommand.DIRECT_FREE_BLUE, restart=Restart.FREE_KICK, restart_team=Team.BLUE, may_touch=True
    )
    games = [(0, waiting), (100, replace(waiting, restart=None, restart_team=None, may_touch=False))]
    free = replace(recording, games=games)
    at_tick(page, free, tmp_path, 50)
    assert page.find("#word").text == "Direct free blue · free kick for blue"
    at_tick(page, free, tmp_path, 150)
    assert page.find("#word").text == "In play"


def test_kinds_of_events_are_left_out(page: Page, recording: Recording, tmp_path: Path) -> None:
    events = [Event(1.0, "kick"), Event(2.0, "out"), Event(3.0, "kick")]
    at_tick(page, replace(recording, events=events), tmp_path, 0)
    listed = "return [...document.querySelectorAll('#list .item')].filter(item => !item.hidden).length"
    assert page.js(listed) == 3
    page.button("Kick").click()
    assert page.js(listed) == 1
    page.find("body").send_keys(".")
    assert page.js("return document.querySelector('#line').getAttribute('aria-valuenow')") == "2.00"
    page.button("Kick").click()
    assert page.js(listed) == 3
