"""A scripted person plays Table 4 through the live page's own input."""

import threading
from collections.abc import Iterator
from typing import Any

import pytest

from paper.table4 import HUMAN, Conditions, table4
from paper.table4_human import HumanRuns
from paper.table4_rows import PAPER
from paper.table4_runs import play_attempt
from paper.table4_starts import LIMITS, drawn_starts, table4_scenario
from robobt.live.server import Server
from robobt.live.session import Live
from robobt.match.runner import trial_seed
from tests.live.chromium import Page, chromium
from tests.live.human import GAMEPAD, PLAYER

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    with chromium(tmp_path_factory.mktemp("chromium")) as page:
        yield page


def played(page: Page, runs: int, trials: tuple[str, ...]) -> Any:
    """Let the scripted person play; return the table."""
    results: list[Any] = []
    with Server() as server:
        live = Live(server)

        def run() -> None:
            human = HumanRuns(live, countdown=0.3, look=0.1)
            results.append(
                table4(
                    runs,
                    combinations=(),
                    conditions=Conditions(limits=("paper",)),
                    trials=trials,
                    human=human,
                )
            )

        thread = threading.Thread(target=run)
        thread.start()
        try:
            page.open(server.url)
            page.find("#field").click()
            page.js(GAMEPAD)
            page.js(PLAYER)
            thread.join(60.0 * runs)
        finally:
            live.end()
            thread.join()
    (result,) = results
    return result


@pytest.mark.slow
def test_a_person_plays_from_the_same_starts_by_the_same_clock(page: Page) -> None:
    result = played(page, 2, ("1",))
    row = result["limits"]["paper"]["1"]["rows"][HUMAN]
    assert row["to_ball"]["n"] == 2
    assert row["goals"].count >= 1
    scenario = drawn_starts(table4_scenario("1", None, limits=LIMITS["paper"]))
    starts = [play_attempt(scenario, trial_seed(scenario.seed, run)).minimum for run in range(2)]
    least = sum(start["to_ball"] for start in starts if start) / 2
    assert result["limits"]["paper"]["1"]["minimum"]["to_ball"] == pytest.approx(least)
    assert least < row["to_ball"]["mean"] < 15.0


@pytest.mark.slow
def test_a_person_plays_all_of_the_papers_protocol(page: Page) -> None:
    result = played(page, 25, ("1", "2"))
    for trial in ("1", "2"):
        row = result["limits"]["paper"][trial]["rows"][HUMAN]
        print(
            trial,
            row["to_ball"],
            row["total"],
            row["goals"].count,
            "of 25; the paper:",
            PAPER[trial]["human"],
        )
        assert row["total"]["n"] > 20
