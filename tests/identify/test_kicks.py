"""What becomes of a commanded kick, and of a ball that is kicked at the first touch."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from robobt.identify import identify
from robobt.identify.ball import SeenKick, identify_ball
from robobt.identify.free_ball import stretches
from robobt.identify.kicks import KickEstimate, identify_kicks
from robobt.identify.observations import Observations
from robobt.sim import SimSettings
from tests.identify.made import PERIOD, kicked, pushed, touched


def settings(kept: float, returned: float) -> SimSettings:
    limits = {"touch_kept": kept, "touch_returned": returned}
    return SimSettings.model_validate({"limits": limits, "realism": {"ball_noise": 0.0005}})


@cache
def touches(kept: float, returned: float) -> tuple[Observations, tuple[SeenKick, ...]]:
    """What cameras saw of 16 touches, and the kicks in it."""
    seen = touched(settings(kept, returned), 16)
    return seen, tuple(kicks_of(seen))


def kicks_of(seen: Observations) -> list[SeenKick]:
    return identify_ball(seen, stretches(seen)).kicks


def identified(seen: Observations, kicks: list[SeenKick]) -> KickEstimate:
    return identify_kicks(seen, kicks, PERIOD)


@pytest.mark.parametrize(("kept", "returned"), [(1.0, 0.0), (0.4, 0.1)])
def test_what_a_touch_keeps_and_gives_back_is_known(kept: float, returned: float) -> None:
    seen, kicks = touches(kept, returned)
    found = identified(seen, list(kicks))
    assert found.kept.count > 8
    assert found.kept.seen
    assert found.kept.value == pytest.approx(kept, abs=0.05)
    assert found.returned.value == pytest.approx(returned, abs=0.05)
    assert found.kept.low < kept < found.kept.high


def test_three_touches_are_not_enough() -> None:
    seen, kicks = touches(0.4, 0.1)
    assert not identified(seen, [it for it in kicks if it.came is not None][:3]).kept.seen


def test_one_misread_touch_of_a_few_widens_the_interval() -> None:
    """A ball that met the hull before the mouth leaves elsewhere than a touch would send it."""
    seen, kicks = touches(1.0, 0.0)
    few = [it for it in kicks if it.came is not None][:5]
    aside = [abs(np.sin(it.direction)) for it in few]
    hardest = few[int(np.argmax(aside))]
    misread = [replace(it, direction=0.6 * it.direction) if it is hardest else it for it in few]
    found = identified(seen, misread).kept
    assert not found.seen or found.low < 1.0 < found.high


def test_a_robot_that_holds_the_ball_tells_nothing_of_touches() -> None:
    assert not identify(kicked(SimSettings())).kicks.kept.seen


@pytest.mark.parametrize("carried", [0.9, -0.2])
def test_what_a_kick_adds_to_a_ball_that_moves_with_the_robot_is_known(carried: float) -> None:
    limits = {"kick_carried": carried}
    seen = pushed(SimSettings.model_validate({"limits": limits, "realism": {"ball_noise": 0.0005}}), 9)
    found = identified(seen, kicks_of(seen)).carried
    assert found.seen
    assert found.count >= 5
    assert found.value == pytest.approx(carried, abs=0.06)
    assert found.low < carried < found.high


def test_kicks_from_a_standing_robot_do_not_tell_what_a_kick_adds() -> None:
    seen = kicked(SimSettings(), kicks=6)
    assert not identified(seen, kicks_of(seen)).carried.seen
