"""How the ball slides and rolls, and what kicks do, is found from how it was seen to move."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from benchmarks.blind.ahead import misses_ahead
from robobt.identify.ball import BallEstimate, identify_ball, model_of
from robobt.identify.free_ball import stretches
from robobt.identify.kicks import identify_kicks
from robobt.identify.observations import Observations
from robobt.sim import SimSettings
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import BallSettings
from robobt.world.ball_model import DEFAULT_BALL
from tests.identify.made import kicked

pytestmark = pytest.mark.integration

BALL = BallSettings(slide_deceleration=2.5, switch_share=0.7, roll_deceleration=0.4)
NOISE = RealismSettings(ball_noise=0.001, robot_noise=0.0005, heading_noise=0.003, missing_ball=0.03)


@cache
def seen() -> Observations:
    return kicked(SimSettings(ball=BALL, realism=NOISE))


@cache
def found() -> BallEstimate:
    return identify_ball(seen(), stretches(seen()))


@pytest.mark.parametrize("name", ["slide_deceleration", "roll_deceleration", "switch_share"])
def test_a_ball_that_was_kicked_is_known(name: str) -> None:
    figure = getattr(found(), name)
    assert figure.seen
    assert figure.value == pytest.approx(getattr(BALL, name), rel=0.02)
    # Wider than a single interval, which misses one time in twenty.
    assert abs(figure.value - getattr(BALL, name)) < 2.0 * figure.half_width + 1e-9


def test_the_noise_of_the_ball_is_known() -> None:
    assert found().noise.value == pytest.approx(0.001, rel=0.1)


def test_a_ball_leaves_as_fast_as_was_commanded() -> None:
    kicks = identify_kicks(seen(), found().kicks, 0.0)
    assert kicks.share.seen
    assert kicks.share.value == pytest.approx(1.0, abs=0.01)
    assert not kicks.kept.seen
    assert not kicks.returned.seen


def test_the_identified_ball_foretells_better_than_the_default_one() -> None:
    held_out = kicked(SimSettings(ball=BALL, realism=NOISE), seed=1)
    own = misses_ahead(held_out, model_of(found()))
    default = misses_ahead(held_out, DEFAULT_BALL)
    assert len(own) == len(default) > 10
    assert np.sqrt(np.mean(own**2)) < 0.01 < np.sqrt(np.mean(default**2))


def test_a_ball_that_nobody_touched_tells_nothing() -> None:
    nothing = identify_ball(seen().between(0.0, 0.1), [])
    assert not nothing.slide_deceleration.seen
    assert model_of(nothing) == DEFAULT_BALL


def test_a_stretch_is_cut_where_the_ball_jumps_from_camera_to_camera() -> None:
    whole = stretches(seen())
    longest = max(whole, key=lambda it: len(it.times))
    jumped = seen().between(0.0, np.inf)
    jumped.ball[(longest.first + longest.last) // 2 : longest.last + 1] += 0.03
    assert len(stretches(jumped)) == len(whole) + 1
