"""RoboBulls' kick as a skill."""

from __future__ import annotations

from math import pi

from robobt.skills import KickAsRobobulls, KickToTarget, SelectShot
from robobt.skills.store import Pass
from robobt.testing import alone, eventually, frame, goal_for, held, robot, succeeds
from robobt.tree import Sequence, Status
from robobt.world import KickTrigger, Team
from tests.skills.fixed_world import Alone


def test_without_a_target_it_fails() -> None:
    alone = Alone(KickAsRobobulls())
    assert alone.tick(frame(robot())) is Status.FAILURE
    assert alone.tree.feedback_message == "no target"


def test_it_scores_later_than_our_own_kick() -> None:
    times = []
    for kick in (KickToTarget(), KickAsRobobulls()):
        tree = Sequence("shoot", memory=False, children=[SelectShot(), kick])
        trial = alone(tree, (-3.9, 0.0, 0.0), settings="robobulls", period=0.03)
        trial.run(
            8.0,
            eventually("the skill succeeds", succeeds(kick)),
            eventually("the ball is in the goal", goal_for(Team.BLUE)),
        )
        times.append(trial.kicks[0][0])
    assert times[0] < 0.7 * times[1]


def test_a_pass_is_noted_as_its_kick_goes_out() -> None:
    """The target is 3 degrees off: too far for a shot, near enough for a pass."""
    kick, me = Alone(KickAsRobobulls(kick_speed=4.0)), robot(-0.12, 0.0)
    kick.store.pass_ = Pass(2, (3.0, 0.15), 2.0, 1.0)
    for _ in range(30):
        kick.tick(frame(me, held(me), period=0.03))
        if kick.command.kick_speed > 0.0:
            break
        assert kick.store.team.receiver is None
    assert (kick.command.kick_speed, kick.command.kick_trigger) == (4.0, KickTrigger.NOW)
    assert (kick.store.team.receiver, kick.store.team.pass_target) == (2, (3.0, 0.15))


def test_it_forgets_a_kick_that_was_broken_off() -> None:
    kick = KickAsRobobulls()
    alone = Alone(kick)
    me = robot(-0.12, 0.0)
    alone.store.pass_ = Pass(2, (3.0, 0.0), 4.0, 1.0)
    alone.tick(frame(me, held(me), period=0.03))
    assert kick.feedback_message == "lining up"
    kick.stop(Status.INVALID)
    turned = robot(-0.12, 0.0, heading=pi)
    alone.tick(frame(turned, (0.0, 0.0), period=0.03))
    assert kick.feedback_message == "driving behind the ball"
