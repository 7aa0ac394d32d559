"""The report: one page."""

from __future__ import annotations

import xml.etree.ElementTree as Xml
from html.parser import HTMLParser
from pathlib import Path

import pytest

from robobt.tournament.play import play_tournament
from robobt.tournament.recordings import Keep, Recordings
from robobt.tournament.report import rating_plot, report, write_report
from robobt.tournament.standings import standings_of
from tests.tournament.made_up import plan, played, runner

MATCHES = [played("a", "b & <c>", number, (number, 1)) for number in range(4)]
FOUND = standings_of(MATCHES, ["a", "b & <c>"])


class Page(HTMLParser):
    """Links and text of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.words: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.links += [str(value) for name, value in attrs if name in ("href", "src")]

    def handle_data(self, data: str) -> None:
        self.words.append(data)


def test_the_page_has_every_table_and_needs_nothing_else() -> None:
    page = Page(report({"scenario": "six_v_six"}, FOUND, MATCHES, {}, "a is better"))
    text = " ".join(page.words)
    for said in ("six_v_six", "Ratings", "b & <c>", "a v b & <c>", "Holm's p", "a is better", "2-1-1"):
        assert said in text
    assert page.links == []


def test_the_page_tells_what_went_wrong_as_plain_text() -> None:
    broken = [
        played("a", "b", number, trace="same", errors=2, first_error="<b>no ball</b>") for number in (0, 1)
    ]
    forfeit = played("a", "b", 2, trace="", outcome="forfeit_blue", first_error="<b>it crashed</b>")
    matches = [forfeit, *broken]
    page = report({}, standings_of(matches, ["a", "b"]), matches, {})
    text = " ".join(Page(page).words)
    assert "only 2 of 3 matches differ" in text
    assert "a: lost 1 match by rule; the first: <b>it crashed</b>" in text
    assert "a: trees failed in 4 ticks" in text
    assert "<b>" not in page


def test_the_plot_is_sound_and_has_every_entrant() -> None:
    plot = Xml.fromstring(rating_plot(FOUND.standings))
    assert len(plot.findall("circle")) == 2
    assert {"a", "b & <c>"} <= {(text.text or "") for text in plot.iter("text")}
    low, high = list(plot.iter("text"))[-2:]
    # Labels at the edges run inwards: what is outside the picture is cut off.
    assert [low.get("text-anchor"), high.get("text-anchor")] == ["start", "end"]


@pytest.mark.integration
def test_recorded_matches_are_linked(tmp_path: Path) -> None:
    what = plan(1, entrants=(runner(1.0), runner(2.0)))
    recordings = Recordings(tmp_path / "night.recordings", Keep.ALL, "at 1")
    with what.open_store(tmp_path / "night.sqlite") as store:
        matches = play_tournament(what, store, recordings=recordings).matches
    recordings.path(matches[1].fixture).write_bytes(b"cut off")
    path = tmp_path / "out" / "night.html"
    write_report(path, {}, standings_of(matches, what.names), matches, recordings)
    (link,) = Page(path.read_text()).links
    assert "robobt replay" in (path.parent / link).read_text()


@pytest.mark.integration
def test_recordings_and_pages_of_an_earlier_tournament_are_not_shown(tmp_path: Path) -> None:
    what = plan(1, entrants=(runner(1.0), runner(2.0)))
    recordings = Recordings(tmp_path / "night.recordings", Keep.ALL, "at 1")
    recordings.folder.mkdir()
    for fixture in what.fixtures():
        recordings.page(fixture).write_text("of an earlier tournament")
    with what.open_store(tmp_path / "night.sqlite") as store:
        matches = play_tournament(what, store, recordings=recordings).matches
    write_report(tmp_path / "night.html", {}, standings_of(matches, what.names), matches, recordings)
    for match in matches:
        assert "of an earlier tournament" not in recordings.page(match.fixture).read_text()
