from robobt.skills.aim.pass_is_open import PassIsOpen
from robobt.skills.aim.pass_rater import PassRater
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone, pass_to

ME = robot(0.0, 0.0)
MATE = robot(2.0, 1.0, number=1)
OPEN = frame(ME, held(ME), (MATE,))
BLOCKED = frame(ME, held(ME), (MATE,), (robot(1.0, 0.5),))


def test_it_holds_with_a_free_mate_and_not_without() -> None:
    assert Alone(PassIsOpen()).tick(OPEN) is Status.SUCCESS
    assert Alone(PassIsOpen()).tick(BLOCKED) is Status.FAILURE
    assert Alone(PassIsOpen()).tick(frame(ME, held(ME))) is Status.FAILURE


def test_it_writes_nothing() -> None:
    alone = Alone(PassIsOpen())
    kept = alone.store.pass_ = pass_to(4, 1.0, 1.0)
    alone.tick(OPEN)
    alone.tick(BLOCKED)
    assert alone.store.pass_ is kept


def test_how_open_is_a_parameter() -> None:
    skill = PassIsOpen(min_score=0.99)
    assert Alone(skill).tick(OPEN) is Status.FAILURE
    assert "scores" in skill.feedback_message
    assert Alone(PassIsOpen(rater=PassRater(min_distance=3.0))).tick(OPEN) is Status.FAILURE
