"""Which matches are kept as recordings."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.tournament.fixtures import Fixture
from robobt.tournament.recordings import Keep, Recordings
from tests.tournament.made_up import played

MATCHES = [
    played("a", "b", 0, (0, 2)),
    played("b", "a", 0, (1, 0)),
    played("a", "b", 1, (1, 1)),
    played("a", "c", 0, (3, 0)),
    played("c", "a", 0, (0, 1)),
    played("b", "c", 0, (0, 9)),
]


@pytest.mark.parametrize(
    ("keep", "kept"),
    [
        (Keep.ALL, {match.fixture for match in MATCHES}),
        (Keep.LOST, {Fixture("a", "b", 0), Fixture("b", "a", 0)}),
        (Keep.WORST, {Fixture("a", "b", 0), Fixture("c", "a", 0)}),
    ],
)
def test_recordings_are_kept_of_the_first_entrants_matches(keep: Keep, kept: set[Fixture]) -> None:
    recordings = Recordings(Path(), keep, "a")
    assert recordings.kept(MATCHES) == recordings.kept(MATCHES[::-1]) == kept


def test_a_forfeit_is_lost() -> None:
    forfeit = played("b", "a", 2, (0, 3), outcome="forfeit_yellow", trace="")
    assert forfeit.fixture in Recordings(Path(), Keep.LOST, "a").kept([*MATCHES, forfeit])


def test_no_two_matches_share_a_file() -> None:
    recordings = Recordings(Path(), Keep.ALL, "a")
    alike = [("a b", "c"), ("a_b", "c"), ("a/b", "c"), ("a", "b c"), ("../a", "c"), ("x" * 300, "c")]
    paths = {recordings.path(Fixture(blue, yellow, 0)) for blue, yellow in alike}
    assert len(paths) == len(alike)
    assert all(path.parent == Path() and len(path.name) < 200 for path in paths)
