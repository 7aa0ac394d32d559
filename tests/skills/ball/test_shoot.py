from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from robobt.models.file import ModelError
from robobt.skills import Shoot
from robobt.skills.ball import shoot
from robobt.testing import (
    alone,
    always,
    eventually,
    frame,
    goal_for,
    held,
    inside_the_field,
    robot,
)
from robobt.testing.frames import HELD
from robobt.tree import Status
from robobt.world import KickTrigger, RobotCommand, Team
from robobt.world.limits import RobotLimits
from tests.models.made_models import Aimed, Faulty, shoot_card, write_model
from tests.skills.fixed_world import Alone, shot_at


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> str:
    return str(write_model(tmp_path_factory.mktemp("models"), Aimed(), shoot_card()))


def test_a_model_of_another_skill_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="for GoToBall, not for Shoot"):
        Shoot(policy=str(write_model(tmp_path)))


def test_the_shipped_policy_is_asked_for_when_the_leaf_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.models.find.model_folders", lambda: [tmp_path])
    with pytest.raises(ModelError, match="no model is called 'shoot_ddpg'"):
        Shoot(policy="ddpg")
    write_model(tmp_path, Aimed(), shoot_card("shoot_ddpg"))
    me = robot(2.0, 0.0, contact=True)
    assert Alone(Shoot(policy="ddpg")).tick(frame(me, ball=held(me))) is Status.RUNNING


@pytest.mark.parametrize("learned", [False, True])
class TestEveryPolicy:
    def leaf(self, learned: bool, model: str) -> Shoot:
        return Shoot(policy=model if learned else "geometric")

    @pytest.mark.integration
    def test_it_fails_without_the_ball_in_the_mouth(self, learned: bool, model: str) -> None:
        alone = Alone(self.leaf(learned, model))
        assert alone.tick(frame(robot(), ball=(HELD, 0.0))) is Status.FAILURE
        assert alone.command == RobotCommand()

    def test_it_turns_the_shorter_way_and_holds_the_ball(self, learned: bool, model: str) -> None:
        for heading, side in ((2.0, -1.0), (-2.0, 1.0)):
            me = robot(1.0, 0.0, heading, contact=True)
            alone = Alone(self.leaf(learned, model))
            assert alone.tick(frame(me, ball=held(me))) is Status.RUNNING
            assert side * alone.command.omega > 0.0
            assert alone.command.kick_speed == 0.0
            assert alone.command.dribbler

    def test_it_kicks_when_the_goal_lies_ahead_and_succeeds_once_the_ball_has_left(
        self, learned: bool, model: str
    ) -> None:
        alone = Alone(self.leaf(learned, model))
        me = robot(2.0, 0.0, contact=True)
        assert alone.tick(frame(me, ball=held(me))) is Status.RUNNING
        assert alone.command.kick_speed > 0.0
        assert alone.command.kick_trigger is KickTrigger.NOW
        gone = frame(robot(2.0, 0.0), ball=(2.2, 0.0, 5.0, 0.0), time=0.03)
        assert alone.tick(gone) is Status.SUCCESS

    def test_it_kicks_softer_by_what_the_kick_adds_to_a_ball_that_moves_ahead(
        self, learned: bool, model: str
    ) -> None:
        kicks = []
        for carried in (0.0, 0.9):
            alone = Alone(self.leaf(learned, model))
            me = robot(2.0, 0.0, contact=True, limits=RobotLimits(kick_carried=carried))
            alone.tick(frame(me, ball=(*held(me), 1.0, 0.0)))
            kicks.append(alone.command.kick_speed)
        assert kicks[1] == pytest.approx(kicks[0] - 0.9)

    def test_it_bears_a_tick_without_contact_but_not_many(self, learned: bool, model: str) -> None:
        alone = Alone(self.leaf(learned, model))
        me = robot(2.0, 0.0, 2.0, contact=True)
        alone.tick(frame(me, ball=held(me)))
        bounced = robot(2.0, 0.0, 2.0)
        assert alone.tick(frame(bounced, ball=held(me), time=0.1)) is Status.RUNNING
        assert alone.tick(frame(bounced, ball=held(me), time=0.2)) is Status.FAILURE

    @pytest.mark.parametrize("heading", [0.3, 1.5, -2.5])
    def test_it_scores_in_the_simulator(self, learned: bool, model: str, heading: float) -> None:
        me = robot(2.0, 0.5, heading)
        tree = self.leaf(learned, model)
        trial = alone(tree, (2.0, 0.5, heading), held(me), "robobulls", period=0.03)
        trial.run(
            6.0,
            eventually("the ball is in the goal", goal_for(Team.BLUE)),
            always("inside the field", inside_the_field),
        )


def test_the_hand_written_policy_aims_at_the_selected_shot() -> None:
    alone = Alone(Shoot())
    alone.store.shot = shot_at(4.5, 0.45)
    me = robot(3.0, 0.0, 0.0, contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == 0.0
    assert alone.command.omega > 0.0
    alone.store.shot = None
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.kick_speed == shoot.GeometricShot().kick_speed


def test_the_hand_written_policy_allows_for_the_balls_sideways_velocity() -> None:
    # At 3 m/s across and 6.4 m/s ahead the ball leaves 25 degrees to the left, past the post.
    alone = Alone(Shoot())
    me = robot(3.0, 0.0, 0.0, contact=True)
    alone.tick(frame(me, ball=(*held(me), 0.0, 3.0)))
    assert alone.command.kick_speed == 0.0


def test_a_gentle_shot_is_a_kick_even_where_the_ball_is_faster_than_that() -> None:
    alone = Alone(Shoot())
    me = robot(3.0, 0.0, 0.0, contact=True, limits=RobotLimits(kick_carried=0.9))
    alone.tick(frame(me, ball=(*held(me), 1.0, 0.0)))
    assert shoot.GeometricShot(kick_speed=0.5)(alone.store).kick_speed > 0.0


def test_what_is_no_action_fails_the_leaf_and_stops_the_robot(tmp_path: Path) -> None:
    # Entry 5 is the distance to the goal.
    module = Faulty("nan", entry=5, outputs=2)
    leaf = Shoot(policy=str(write_model(tmp_path, module, shoot_card())))
    alone = Alone(leaf)
    me = robot(-40.0, 0.0, pi, contact=True)
    assert alone.tick(frame(me, ball=held(me))) is Status.FAILURE
    assert alone.command == RobotCommand()
    assert "no number" in leaf.feedback_message
