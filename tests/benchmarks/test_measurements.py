"""What the pages of measurements say, and which of them are stale."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks.behaviour import ROOMS, behaviour
from benchmarks.measurements import PAGES, RECORD, Measurement, changed_rooms, read_page
from robobt.config.errors import ConfigError

ONE = Measurement("speed.md", "Arenas", "2026-11-24", "1b7a2d5", ("sim", "motion"))


def page(folder: Path, *lines: str) -> Path:
    path = folder / "speed.md"
    path.write_text("\n".join(("# Speed", "", "## Arenas", "", *lines, "")))
    return path


def test_every_measurement_says_when_of_what_and_what_it_rests_on() -> None:
    for path in PAGES.glob("*.md"):
        found = read_page(path)
        assert found or path.name == "index.md", path
        assert len({one.title for one in found}) == len(found), f"{path}: two sections have one title"


def test_a_measurement_is_read(tmp_path: Path) -> None:
    path = page(tmp_path, "Measured 2026-11-24 at `1b7a2d5`; rests on sim, motion.")
    assert read_page(path) == [ONE]


def test_what_stands_in_code_is_no_measurement(tmp_path: Path) -> None:
    assert read_page(page(tmp_path, "```text", "Measured by hand", "```")) == []


@pytest.mark.parametrize(
    ("line", "problem"),
    [
        ("Measured yesterday at `1b7a2d5`; rests on sim.", "is not of the form"),
        ("Measured 2026-11-24 at `main`; rests on sim.", "is not of the form"),
        ("Measured 2026-11-24 at `1b7a2d5`.", "is not of the form"),
        ("Measured 2026-11-24 at `1b7a2d5`; rests on sim, attic.", "there is no room attic"),
    ],
)
def test_a_line_of_another_form_is_told_by_file_and_line(tmp_path: Path, line: str, problem: str) -> None:
    with pytest.raises(ConfigError, match=problem) as told:
        read_page(page(tmp_path, line))
    assert str(told.value).startswith(f"{tmp_path / 'speed.md'}:5: ")


NOW = {"sim": "a", "motion": "b", "shots": "c"}


def test_a_measurement_is_stale_once_a_room_that_it_rests_on_has_changed() -> None:
    assert changed_rooms(ONE, {"1b7a2d5": NOW | {"motion": "old"}}, NOW) == ["motion"]


def test_a_change_of_other_rooms_leaves_it() -> None:
    assert changed_rooms(ONE, {"1b7a2d5": NOW | {"shots": "old"}}, NOW) == []


def test_nothing_is_known_where_nothing_was_recorded() -> None:
    assert changed_rooms(ONE, {}, NOW) is None


def test_a_room_that_does_the_same_has_the_same_hash() -> None:
    quick = ("world", "tree", "motion", "tournament")
    first = behaviour(quick)
    assert first == behaviour(quick)
    assert len(set(first.values())) == len(quick)


def test_a_law_that_decides_otherwise_changes_the_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    from robobt.tournament import ratings

    before = behaviour(["tournament"])
    monkeypatch.setattr(ratings, "_PRIOR", 2.0 * ratings._PRIOR)
    assert behaviour(["tournament"]) != before


def test_there_is_a_probe_for_every_room_that_decides() -> None:
    assert set(ROOMS) >= {
        "sim",
        "motion",
        "skills",
        "plays",
        "match",
        "learning",
        "league",
        "models",
        "shots",
    }


def test_no_room_by_another_name() -> None:
    with pytest.raises(KeyError):
        behaviour(["attic"])


def test_what_was_recorded_names_every_room() -> None:
    kept = json.loads(RECORD.read_text())
    assert kept["processor"]
    assert all(set(rooms) == set(ROOMS) for rooms in kept["commits"].values())
    measured = {one.commit[:7] for path in PAGES.glob("*.md") for one in read_page(path)}
    assert set(kept["commits"]) & measured
