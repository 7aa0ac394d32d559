"""The dribbling challenge: gates count in their order, with robot and ball behind them as a whole."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.dribbling import GateDribbling, GateJudge
from robobt.challenges.run import ChallengeEntry, play_run
from robobt.skills.challenges.carry_along import GATE_POSTS, GATES
from robobt.world.field import DIVISION_B
from robobt.world.game import OPEN_PLAY
from robobt.world.state import BallState, Frame, RobotState
from robobt.worlds import sim_world

POSTS = tuple(RobotState(number, *place) for number, place in GateDribbling.posts.items())
HELD = 0.11
"""Distance of a ball in the mouth from the robot's centre [m]."""


def through(judge: GateJudge, gate: str, out: bool = True, to: float = 0.3, aside: float = 0.0) -> bool:
    """Carry the ball straight through a gate in small steps; return whether the trial is over."""
    a, b = (np.array(GateDribbling.posts[number]) for number in GATE_POSTS[gate])
    along = (b - a) / np.hypot(*(b - a))
    normal = np.array((along[1], -along[0])) * (1.0 if out else -1.0)
    middle = 0.5 * (a + b) + aside * along
    over = False
    for way in np.arange(-0.4, to + 1e-9, 0.02):
        robot = middle + way * normal
        ball = robot + HELD * normal
        (x, y), (ball_x, ball_y), facing = robot.tolist(), ball.tolist(), float(np.arctan2(*normal[::-1]))
        me = RobotState(0, x, y, facing, ball_contact=True)
        over = judge.see(Frame(0.0, DIVISION_B, BallState(ball_x, ball_y), (me,), POSTS), OPEN_PLAY)
        if over:
            break
    return over


def test_a_gate_counts_each_time_it_is_passed() -> None:
    judge = GateJudge()
    through(judge, "A")
    assert judge.passed == 1
    through(judge, "A", out=False)
    assert judge.passed == 2


def test_a_gate_out_of_order_does_not_count() -> None:
    judge = GateJudge()
    through(judge, "B")
    assert judge.passed == 0


@pytest.mark.parametrize(("to", "passed"), [(0.08, 0), (0.12, 1)])
def test_the_robot_has_to_be_through_as_a_whole(to: float, passed: int) -> None:
    judge = GateJudge()
    through(judge, "A", to=to)
    assert judge.passed == passed


def test_a_touch_of_a_post_fails_the_trial() -> None:
    judge = GateJudge()
    through(judge, "A")
    assert through(judge, "A", aside=0.2, out=False)
    assert judge.figures()["gates"] == 0.0


def test_a_way_round_the_gate_does_not_count() -> None:
    judge = GateJudge()
    through(judge, "A", aside=0.8)
    assert judge.passed == 0


def test_a_ball_kicked_through_and_caught_again_does_not_count() -> None:
    judge = GateJudge()
    a, b = (np.array(GateDribbling.posts[number]) for number in GATE_POSTS["A"])
    along = (b - a) / np.hypot(*(b - a))
    normal, middle = np.array((along[1], -along[0])), 0.5 * (a + b)
    facing = float(np.arctan2(*normal[::-1]))

    def seen(robot: float, ball: float) -> None:
        (x, y), (ball_x, ball_y) = (middle + robot * normal).tolist(), (middle + ball * normal).tolist()
        me = RobotState(0, x, y, facing, ball_contact=ball - robot <= HELD)
        judge.see(Frame(0.0, DIVISION_B, BallState(ball_x, ball_y), (me,), POSTS), OPEN_PLAY)

    for way in np.arange(-0.4, -0.2, 0.02):
        seen(way, way + HELD)
    for ahead in np.arange(0.0, 0.5, 0.05):
        seen(-0.2, -0.2 + HELD + ahead)
    for way in np.arange(-0.2, 0.3, 0.02):
        seen(way, max(0.39, way + HELD))
    assert judge.passed == 0
    # Back through the gate with the ball, nothing is lost: it counts.
    for way in np.arange(0.3, -0.4, -0.02):
        seen(way, way + HELD)
    assert judge.passed == 1


def test_the_best_trial_has_most_gates_then_least_time() -> None:
    trials = [
        {"gates": 3.0, "failed": 0.0, "time": 9.0},
        {"gates": 0.0, "failed": 1.0},
        {"gates": 3.0, "failed": 0.0, "time": 7.0},
    ]
    assert GateDribbling().score(trials) == {"gates": 3.0, "failed": 1.0, "time": 7.0}


@pytest.mark.integration
def test_the_play_passes_all_gates_and_places_the_ball() -> None:
    result = play_run(ChallengeEntry("dribbling", ("gate_run", {})), 0, 1, sim_world)
    assert (result.score, result.figures["placed"]) == (float(len(GATES)), 1.0)
