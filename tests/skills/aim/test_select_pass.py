import pytest

from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.aim.select_pass import SelectPass
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import Frame, RobotState
from tests.skills.fixed_world import Alone, pass_to

ME = robot(0.0, 0.0)


def scene(*mates: RobotState, opponents: tuple[RobotState, ...] = (), time: float = 0.0) -> Frame:
    return frame(ME, held(ME), mates, opponents, time=time)


FREE = robot(2.0, 1.0, number=1)


def test_the_best_pass_is_written() -> None:
    alone = Alone(SelectPass())
    assert alone.tick(scene(FREE, robot(-1.0, 1.0, number=2))) is Status.SUCCESS
    chosen = alone.store.pass_
    assert chosen is not None
    assert chosen.receiver == 1
    assert chosen.target == (2.0, 1.0)


def test_without_a_receiver_it_fails_and_clears_the_pass() -> None:
    skill = SelectPass()
    alone = Alone(skill)
    alone.store.pass_ = pass_to(1, 2.0, 1.0)
    assert alone.tick(scene()) is Status.FAILURE
    assert alone.store.pass_ is None
    assert "team-mate" in skill.feedback_message


def test_a_pass_worse_than_asked_for_is_none() -> None:
    behind = robot(-2.0, 0.5, number=1)
    skill = SelectPass(min_score=0.8)
    assert Alone(skill).tick(scene(behind)) is Status.FAILURE
    assert "scores" in skill.feedback_message
    assert Alone(SelectPass(min_score=0.1)).tick(scene(behind)) is Status.SUCCESS


def test_in_between_looks_the_choice_stands() -> None:
    alone = Alone(SelectPass(every=0.1))
    block = (robot(1.0, 0.5),)
    alone.tick(scene(FREE, time=0.0))
    assert alone.tick(scene(FREE, opponents=block, time=0.05)) is Status.SUCCESS
    assert alone.store.pass_ is not None
    assert alone.tick(scene(FREE, opponents=block, time=0.1)) is Status.FAILURE
    assert alone.store.pass_ is None


@pytest.mark.parametrize(("keep", "receivers"), [(0.1, {1}), (0.0, {1, 2})])
def test_it_stays_with_a_receiver_that_is_nearly_as_good(keep: float, receivers: set[int]) -> None:
    alone = Alone(SelectPass(keep=keep, every=0.0))
    chosen = set()
    for better in (1, 2, 1, 2):
        mates = (
            robot(2.0 + (0.1 if better == 1 else 0.0), 1.2, number=1),
            robot(2.0 + (0.1 if better == 2 else 0.0), -1.2, number=2),
        )
        assert alone.tick(scene(*mates)) is Status.SUCCESS
        assert alone.store.pass_ is not None
        chosen.add(alone.store.pass_.receiver)
    assert chosen == receivers


def test_what_counts_is_the_raters_to_say() -> None:
    near = robot(0.8, 0.0, number=1)
    assert Alone(SelectPass()).tick(scene(near)) is Status.FAILURE
    assert Alone(SelectPass(rater=PassRater(min_distance=0.5))).tick(scene(near)) is Status.SUCCESS
