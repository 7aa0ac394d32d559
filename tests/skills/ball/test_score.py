"""Score attacks as its policy says, with the goalkeeper that there is."""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from pathlib import Path

import numpy as np
import pytest

from robobt.models.file import ModelError, ModelFile
from robobt.models.policy import Policy, load_policy
from robobt.skills import Score
from robobt.skills.ball import learned_control
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, BallState, Frame, GameState, RobotCommand, RobotLimits, RobotState
from robobt.world.game import Team, TeamStatus
from robobt.world.scoring import SCORE_ON_GOALKEEPER, score_on_goalkeeper_of
from tests.models.made_models import Passing, score_card, write_model
from tests.skills.fixed_world import Alone
from tests.skills.side_by_side import the_leaf_does_what_it_does_in_training


def score(folder: Path) -> Alone:
    return Alone(Score(policy=str(write_model(folder, Passing(), score_card()))))


def test_it_drives_and_kicks_with_the_dribbler_on(tmp_path: Path) -> None:
    alone, me = score(tmp_path), robot(2.0, 0.0)
    left, right = robot(4.3, 0.4, number=3), robot(4.3, -0.4, number=3)
    assert alone.tick(frame(me, ball=(2.1, 0.0), opponents=(left,))) is Status.RUNNING
    assert alone.command.vx == pytest.approx(0.1 * 3.0, abs=1e-4)
    assert alone.command.kick_speed == 6.0
    assert alone.command.dribbler
    alone.tick(frame(me, ball=(2.1, 0.0), opponents=(right,), time=0.1))
    assert alone.command.kick_speed == 0.0


@pytest.mark.parametrize(("held", "status"), [(1.4, Status.FAILURE), (1.6, Status.RUNNING)])
def test_it_leaves_the_ball_of_a_weak_dribbler_to_others(tmp_path: Path, held: float, status: Status) -> None:
    limits = RobotLimits(hold_acceleration=3.0)
    model = write_model(tmp_path, Passing(), score_card().model_copy(update={"limits": limits}))
    alone = Alone(Score(policy=str(model), weakest=0.5))
    me = replace(robot(2.0, 0.0), limits=RobotLimits(hold_acceleration=held))
    assert alone.tick(frame(me, ball=(2.1, 0.0), opponents=(robot(4.3, 0.4, number=3),))) is status


@pytest.mark.parametrize(
    ("weakest", "in_training", "status"),
    [(0.5, None, Status.FAILURE), (0.5, 1.1, Status.RUNNING), (0.0, None, Status.RUNNING)],
)
def test_it_leaves_a_ball_that_gets_lost_sideways_to_others(
    tmp_path: Path, weakest: float, in_training: float | None, status: Status
) -> None:
    limits = RobotLimits(carry_aside=in_training)
    model = write_model(tmp_path, Passing(), score_card().model_copy(update={"limits": limits}))
    alone = Alone(Score(policy=str(model), weakest=weakest))
    me = replace(robot(2.0, 0.0), limits=RobotLimits(carry_aside=1.1))
    assert alone.tick(frame(me, ball=(2.1, 0.0), opponents=(robot(4.3, 0.4, number=3),))) is status


@pytest.mark.parametrize(
    ("held", "in_training", "ball", "slow"),
    [
        (0.35, 3.0, 2.1, True),
        # A dribbler as in training, a better one, and a ball that is not there yet.
        (0.35, 0.35, 2.1, False),
        (1.5, 3.0, 2.1, False),
        (0.35, 3.0, 2.4, False),
    ],
)
def test_with_a_weak_dribbler_it_changes_its_velocity_at_the_ball_as_slowly_as_in_training(
    tmp_path: Path, held: float, in_training: float, ball: float, slow: bool
) -> None:
    limits = RobotLimits(hold_acceleration=in_training, acceleration=2.0, turn_acceleration=20.0)
    model = write_model(tmp_path, Passing(), score_card().model_copy(update={"limits": limits}))
    alone = Alone(Score(policy=str(model)))
    me = replace(robot(2.0, 0.0), vx=1.0, omega=1.0, limits=RobotLimits(hold_acceleration=held))
    seen = frame(me, ball=(ball, 0.0), opponents=(robot(4.3, 0.4, number=3),))
    alone.tick(seen)
    commanded = alone.command
    change = hypot(commanded.vx - 1.0, commanded.vy)
    assert (change <= 2.0 * seen.period + 1e-9) is slow
    assert (abs(commanded.omega - 1.0) <= 20.0 * seen.period + 1e-9) or not slow


@pytest.mark.parametrize("weakest", [-0.1, 1.1])
def test_the_weakest_dribbler_is_a_share(weakest: float) -> None:
    with pytest.raises(ValueError, match="weakest must be 0 to 1"):
        Score(weakest=weakest)


def test_one_trained_against_defenders_plays_as_in_training(tmp_path: Path) -> None:
    the_leaf_does_what_it_does_in_training("ScoreOnGoalkeeperAndDefenders", "Score", tmp_path)


def test_a_model_that_ships_is_loaded_when_it_is_needed_and_any_other_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    loaded: list[str] = []

    def load(file: ModelFile) -> Policy:
        loaded.append(file.path.stem)
        return load_policy(file)

    monkeypatch.setattr(learned_control, "load_policy", load)
    monkeypatch.setattr(learned_control, "_shipped", {})
    alone = Alone(Score(policy="score_on_goalkeeper_ppo"))
    assert not loaded
    learned_control.load_shipped_policies()
    assert loaded == ["score_on_goalkeeper_ppo"]
    for time in (0.0, 1.0):
        assert alone.tick(frame(robot(), ball=(3.0, 0.0), time=time)) is Status.RUNNING
    assert loaded == ["score_on_goalkeeper_ppo"] * 2
    model = write_model(tmp_path, Passing(), score_card())
    Score(policy=str(model))
    assert loaded[2:] == [model.stem]


def test_one_that_cannot_be_loaded_fails_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def load(file: ModelFile) -> Policy:
        raise ModelError(f"{file.path.name}: needs torch to run")

    monkeypatch.setattr(learned_control, "load_policy", load)
    alone = Alone(Score(policy="score_on_goalkeeper_ppo"))
    learned_control.load_shipped_policies()
    assert alone.tick(frame(robot(), ball=(3.0, 0.0))) is Status.FAILURE
    assert "needs torch" in alone.tree.feedback_message
    assert alone.command == RobotCommand()


def seen(*opponents: RobotState, keeper: int | None = None) -> dict[str, float]:
    me = RobotState(0, 1.0, 1.0, np.pi / 2, 0.5, 0.0, 1.0)
    game = GameState(yellow=TeamStatus(keeper=keeper))
    now = Frame(0.0, DIVISION_B, BallState(2.0, 1.0, 0.0, 3.0), (me,), opponents, Team.BLUE, game=game)
    names = [entry.name for entry in SCORE_ON_GOALKEEPER.entries]
    return dict(zip(names, score_on_goalkeeper_of(now, me).tolist(), strict=True))


def test_it_sees_everything_in_the_robots_frame() -> None:
    # It looks along y: what is at +x lies to its right.
    row = seen(RobotState(1, 4.0, 0.0, 0.0, 0.0, 2.0))
    assert (row["vx"], row["vy"], row["omega"]) == pytest.approx((0.0, -0.5, 1.0))
    assert (row["ball_x"], row["ball_y"]) == pytest.approx((0.0, -1.0))
    assert (row["ball_vx"], row["ball_vy"]) == pytest.approx((3.0, 0.0))
    assert (row["upper_post_x"], row["upper_post_y"]) == pytest.approx((-0.5, -3.5))
    assert (row["lower_post_x"], row["lower_post_y"]) == pytest.approx((-1.5, -3.5))
    assert (row["keeper_x"], row["keeper_y"]) == pytest.approx((-1.0, -3.0))
    assert (row["keeper_vx"], row["keeper_vy"]) == pytest.approx((2.0, 0.0))
    angle = np.arctan2(-1.0, 3.5) - np.pi / 2
    assert (row["sin_goal"], row["cos_goal"]) == pytest.approx((np.sin(angle), np.cos(angle)))
    # It points along the goal line, and the ball moves on across it.
    assert row["aim"] == 1.0
    assert row["keeper_aside"] == -0.5


def test_it_sees_where_a_kick_would_go_and_by_how_much_it_would_pass_the_goalkeeper() -> None:
    me, keeper = RobotState(0, 2.5, 0.0, 0.0), RobotState(1, 4.3, 0.3)
    straight, carried = BallState(2.6, 0.0), BallState(2.6, 0.0, 0.0, 0.6)
    rows = [
        score_on_goalkeeper_of(Frame(0.0, DIVISION_B, ball, (me,), (keeper,)), me)
        for ball in (straight, carried)
    ]
    assert rows[0][17:] == pytest.approx((0.0, 0.3))
    # A tenth of the kick's speed across: a tenth of the way.
    assert rows[1][17] == pytest.approx(0.19)
    assert rows[1][18] == pytest.approx((0.3 - 0.17) / np.hypot(1.0, 0.1))


def test_the_goalkeeper_is_who_the_game_names_else_who_is_nearest_to_the_goal() -> None:
    near, far = RobotState(1, 4.0, 0.0), RobotState(2, 1.0, 0.0)
    assert seen(near, far)["keeper_y"] == seen(far, near)["keeper_y"] == pytest.approx(-3.0)
    assert seen(near, far, keeper=2)["keeper_y"] == pytest.approx(0.0)
    assert seen()["keeper_y"] == pytest.approx(-3.5)
