"""What the automatic referee looks for follows from division and settings."""

from __future__ import annotations

import pytest

from robobt.match.referee.automatic import rules_of
from robobt.match.referee.rules.ball_handling import BallSpeed, DoubleTouch, Dribbling
from robobt.match.referee.rules.base import Rule
from robobt.match.referee.rules.contact import Crash, Pushing
from robobt.match.referee.rules.defense_areas import DefenseAreaTouch, KeeperHeld
from robobt.match.referee.rules.play_goes_on import NoProgress
from robobt.match.referee.rules.restart_distances import AreaDistance, KickPointDistance, StopSpeed
from robobt.match.referee.settings import RefereeSettings
from robobt.world.division import Division, division_of
from robobt.world.field import DIVISION_A, DIVISION_B

SWITCHES: dict[str, tuple[object, set[type[Rule]]]] = {
    "crash_speed": (None, {Crash}),
    "max_ball_speed": (None, {BallSpeed}),
    "stop_speed": (None, {StopSpeed}),
    "stop_distance": (None, {KickPointDistance}),
    "defense_areas": (False, {DefenseAreaTouch, AreaDistance}),
    "double_touch": (False, {DoubleTouch}),
    "max_dribble": (None, {Dribbling}),
    "keeper_hold_time": (None, {KeeperHeld}),
    "no_progress_time": (None, {NoProgress}),
}


def rules(division: Division, settings: RefereeSettings) -> set[type[Rule]]:
    return {type(rule) for rule in rules_of(division, settings)}


@pytest.mark.parametrize("division", [division_of(DIVISION_A), division_of(DIVISION_B)], ids=["a", "b"])
@pytest.mark.parametrize("name", SWITCHES)
def test_each_check_has_its_switch(name: str, division: Division) -> None:
    off, gone = SWITCHES[name]
    every = rules(division, RefereeSettings())
    assert rules(division, RefereeSettings(**{name: off})) == every - gone
    assert gone <= every


def test_pushing_is_looked_for_where_it_is_asked_for() -> None:
    division = division_of(DIVISION_B)
    assert rules(division, RefereeSettings(pushing=True)) - rules(division, RefereeSettings()) == {Pushing}


def test_every_setting_without_a_value_is_a_switch() -> None:
    """What may be none has its row above, but for times and numbers that are no checks."""
    others = {"opening_spot", "kickoff_wait", "max_robots", "half_length", "extra_length"}
    fields = RefereeSettings.model_fields
    assert {
        name for name, field in fields.items() if type(None) in getattr(field.annotation, "__args__", ())
    } == (others | {name for name, (off, _) in SWITCHES.items() if off is None})
