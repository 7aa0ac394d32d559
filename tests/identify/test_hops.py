"""How a chipped ball hops is found from where cameras saw it, on the ground or in the air."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

from robobt.identify.ball import identify_ball, model_of
from robobt.identify.free_ball import stretches
from robobt.identify.hops import HopEstimate, identify_hops
from robobt.identify.observations import Observations
from robobt.identify.sources import load_observations
from robobt.sim import SimSettings, SimWorld
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import BallSettings
from robobt.world.field import DIVISION_B
from tests.identify.made import PERIOD, ROBOT, chipped, chips_of, kicked, logged

HOPS = {"first_hop": 0.7, "other_hops": 0.93, "rebound": 0.55}
SETTINGS = SimSettings(
    ball=BallSettings(**HOPS), realism=RealismSettings(ball_noise=0.001, robot_noise=0.001, missing_ball=0.03)
)


def identified(seen: Observations) -> HopEstimate:
    free = stretches(seen)
    ball = identify_ball(seen, free)
    return identify_hops(seen, free, model_of(ball), 0.001)


@cache
def found() -> HopEstimate:
    return identified(chipped(SETTINGS))


@pytest.mark.parametrize("name", HOPS)
def test_what_a_touch_down_leaves_is_known_after_three_chips(name: str) -> None:
    figure = getattr(found(), name)
    assert figure.seen
    assert figure.count == 3
    assert figure.value == pytest.approx(HOPS[name], abs=0.01)
    assert figure.low < HOPS[name] < figure.high


@pytest.mark.parametrize(("cameras", "error"), [(1, 0.0), (4, 0.1)])
def test_cameras_that_see_a_flying_ball_farther_away_tell_the_hops(
    cameras: int, error: float, tmp_path: Path
) -> None:
    """Also cameras that are elsewhere than they say."""
    realism = SETTINGS.realism.model_copy(update={"camera_error": error})
    wrong = SETTINGS.model_copy(update={"realism": realism})
    world = SimWorld(DIVISION_B, {ROBOT: SETTINGS.limits}, wrong, PERIOD)
    logged(tmp_path / "chips.log", world, chips_of(world, 3), cameras)
    figures = identified(load_observations(tmp_path / "chips.log"))
    for name, truth in HOPS.items():
        figure = getattr(figures, name)
        assert figure.seen, name
        assert figure.value == pytest.approx(truth, abs=0.02), name


def test_flat_kicks_tell_nothing_of_hops() -> None:
    seen = kicked(SETTINGS, kicks=6)
    # Nor do they where nobody knows the commands.
    seen.commands[:] = float("nan")
    figures = identified(seen)
    assert [figure.count for figure in figures] == [0, 0, 0]
    assert not any(figure.seen for figure in figures)


def test_a_chip_that_is_seen_up_to_its_first_touch_down_tells_of_that_alone() -> None:
    seen = chipped(SETTINGS, chips=1)
    figures = identified(seen.between(0.0, 0.95))
    assert figures.first_hop.seen
    assert not figures.rebound.seen
    assert not figures.other_hops.seen
