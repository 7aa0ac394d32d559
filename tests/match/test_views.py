"""A team's view stays as it is whatever trees do to it."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from robobt.match.views import KeptView
from robobt.testing import frame, robot
from robobt.world import Frame, RobotState
from robobt.world.ball_model import BallModel
from robobt.world.game import GameState, TeamStatus
from robobt.world.limits import RobotLimits
from robobt.world.records import movers_of


def kept_view(view: Frame) -> KeptView:
    kept = KeptView()
    kept.take(view)
    return kept


def test_what_was_worked_out_of_a_spoilt_view_is_forgotten() -> None:
    view = frame(robot(), opponents=(robot(1.0, 0.0),))
    kept = kept_view(view)
    view.opponents[0].x = 2.0
    assert movers_of(view)[1, 0] == 2.0
    assert kept.mend() is not None
    assert movers_of(view)[1, 0] == 1.0


@pytest.mark.parametrize("attribute", RobotState.__dataclass_fields__)
def test_whatever_of_a_robot_was_changed_is_put_back(attribute: str) -> None:
    view = frame(robot(), opponents=(robot(1.0, 0.0),))
    kept, before = kept_view(view), getattr(view.opponents[0], attribute)
    setattr(view.opponents[0], attribute, "spoilt")
    assert kept.mend() == [f"opponents[0].{attribute}"]
    assert getattr(view.opponents[0], attribute) == before


def _set(thing: object, name: str, value: object) -> None:
    """Assign as a skill does that goes round a class which refuses it."""
    object.__setattr__(thing, name, value)


_SHARED: list[Callable[[Frame], object]] = [
    lambda view: view.game,
    lambda view: view.game.blue,
    lambda view: view.game.yellow,
    lambda view: view.field,
    lambda view: view.ball_model,
    lambda view: view.own[0].limits,
    lambda view: view.opponents[1].limits,
]


def _shared_view() -> Frame:
    # Of its own, for what is spoilt here would stay so for the whole process if it were not put right.
    view = frame(robot(), opponents=(robot(1.0, 0.0), robot(2.0, 0.0)))
    view.game = GameState(blue=TeamStatus(keeper=1), yellow=TeamStatus(keeper=2))
    view.field, view.ball_model = view.field.model_copy(), BallModel()
    view.own[0].limits, view.opponents[1].limits = RobotLimits(), RobotLimits(max_speed=2.0)
    return view


def _values(thing: object) -> dict[str, object]:
    names = getattr(type(thing), "__dataclass_fields__", None) or type(thing).model_fields  # type: ignore[attr-defined]
    return {name: getattr(thing, name) for name in names}


@pytest.mark.parametrize("which", range(len(_SHARED)))
def test_whatever_of_a_read_only_part_was_changed_is_put_back(which: int) -> None:
    view = _shared_view()
    part = _SHARED[which](view)
    before = _values(part)
    for name in before:
        kept = kept_view(view)
        _set(part, name, "spoilt")
        assert kept.mend() is not None, name
        assert _values(part) == before


@pytest.mark.parametrize("which", range(len(_SHARED)))
def test_what_was_deleted_of_a_read_only_part_is_put_back(which: int) -> None:
    view = _shared_view()
    part = _SHARED[which](view)
    before = _values(part)
    kept = kept_view(view)
    for name in before:
        object.__delattr__(part, name)
    assert kept.mend() is not None
    assert _values(part) == before


def test_what_a_read_only_part_works_out_for_itself_is_no_change() -> None:
    view = _shared_view()
    kept = kept_view(view)
    assert view.field.half_length == view.field.length / 2
    assert kept.mend() is None
    _set(view.field, "half_length", 7.0)
    assert kept.mend() is not None
    assert view.field.half_length == view.field.length / 2


@pytest.mark.parametrize("made", [None, {}, {"movers": None, "scene": "nothing"}])
def test_what_was_worked_out_of_a_view_is_forgotten_when_it_is_replaced(made: object) -> None:
    view = _shared_view()
    kept = kept_view(view)
    movers_of(view)
    _set(view, "made", made)
    assert kept.mend() is not None
    assert len(movers_of(view)) == 3
