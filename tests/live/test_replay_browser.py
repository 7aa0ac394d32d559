"""The replay page in a real browser: its charts, and what a game controller says."""

import csv
from dataclasses import replace
from pathlib import Path

import pytest
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.support.ui import Select

from robobt.live.replay_html import write_html
from robobt.match import Match, load_scenario
from robobt.match.recording import Recording, load_recording
from robobt.world.game import GameState, RefereeCommand, TeamStatus
from robobt.worlds import sim_world
from tests.live.chromium import Page

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    path = tmp_path_factory.mktemp("chart") / "m.robobt.arrows"
    scenario = load_scenario("striker_vs_goalie").lasting(6.0)
    with Match(scenario, 3, sim_world, path) as match:
        while match.tick():
            pass
    return load_recording(path)


def test_what_a_game_controller_says_is_shown(page: Page, recording: Recording, tmp_path: Path) -> None:
    status = TeamStatus(keeper=4, max_robots=5, yellow_cards=1)
    game = GameState(RefereeCommand.STOP, upcoming=RefereeCommand.PREPARE_PENALTY_YELLOW, blue=status)
    write_html(replace(recording, games=[(0, game)]), tmp_path / "m.html")
    page.open((tmp_path / "m.html").as_uri())
    said = page.find("#stage").text
    assert said.startswith("Normal first half · next prepare penalty yellow · blue: goalkeeper 4")
    assert "at most 5 robots, 1 yellow" in said


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
    for name in ("blue 0 x [m]", "blue 0 shot.score"):
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
    page.until(saved.exists)
    rows = [*csv.reader(saved.read_text().splitlines())]
    assert rows[0] == ["time [s]", "ball speed [m/s]", "blue 0 x [m]", "blue 0 shot.score"]
    assert 0.15 < len(rows) / len(recording) < 0.35
    times = [float(row[0]) for row in rows[1:]]
    ticks = [int(abs(recording.times - time).argmin()) for time in times]
    assert ticks == [*range(ticks[0], ticks[0] + len(ticks))]
    xs = [float(row[2]) for row in rows[1:]]
    assert xs == pytest.approx(recording.truth.robots[ticks, 0, 0].tolist(), abs=6e-4)
