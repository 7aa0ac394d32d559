"""Score-On-Goalkeeper: who opposes, what is rewarded, and how it ends."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import ScoreOnGoalkeeperSettings, ScoreOnGoalkeeperTask, run_starts
from robobt.learning.envs.score_on_goalkeeper.rewards import ScoreReward, kicked
from robobt.learning.opponents.goalkeepers import Goalkeepers
from robobt.learning.opponents.keepers import GOALKEEPER_KINDS
from robobt.models.actions import command_of
from robobt.sim import SimWorld
from robobt.world import BallState, Placement, RobotId, RobotState, Team
from robobt.world.scoring import score_on_goalkeeper_of

HELD = 0.0968
STAY, KICK = np.array([0.0, 0.0, 0.0, -1.0]), np.array([0.0, 0.0, 0.0, 1.0])
SHIPPED = GOALKEEPER_KINDS.index("shipped")


def start(
    robot: tuple[float, ...], ball: tuple[float, ...] | None = None, keeper: tuple[float, ...] = (4.35, 0.0),
    kind: str = "line", speed: float = 3.0,
) -> list[float]:  # fmt: skip
    x, y, heading = robot
    lies = ball or (x + HELD * np.cos(heading), y + HELD * np.sin(heading), 0.0, 0.0)
    return [x, y, heading, 0, 0, 0, *keeper, np.pi, 0, 0, 0, *lies, GOALKEEPER_KINDS.index(kind), speed, 0.15]


def task(*starts: list[float], **changes: Any) -> ScoreOnGoalkeeperTask:
    made = ScoreOnGoalkeeperTask(ScoreOnGoalkeeperSettings.model_validate(changes), len(starts))
    made.reset_to(starts, seed=0)
    return made


def to_the_end(made: ScoreOnGoalkeeperTask, action: np.ndarray) -> Any:
    for _ in range(400):
        result = made.advance(np.tile(action, (made.n, 1)))
        if made.ended is not None:
            return result
    raise AssertionError("no episode has ended")


def test_a_shot_past_a_goalkeeper_that_is_elsewhere_is_a_goal() -> None:
    made = task(start((3.0, 0.0, 0.0), keeper=(4.35, 1.4), kind="line", speed=0.1))
    result = to_the_end(made, KICK)
    assert result.success[0]
    assert made.ended is not None
    assert made.ended.kick_time[0] < 0.1
    weights = ScoreReward()
    assert result.reward[0] > weights.goal - 0.1
    # What else it earned is the kick, which nobody could have reached.
    assert made.ended.total_reward[0] == pytest.approx(
        weights.goal + weights.aimed + weights.unreached - weights.time * made.ended.ticks[0], abs=0.02
    )


@pytest.mark.parametrize("kind", GOALKEEPER_KINDS)
def test_every_goalkeeper_stops_a_shot_from_afar_at_itself(kind: str) -> None:
    made = task(start((1.0, 0.0, 0.0), kind=kind))
    assert not to_the_end(made, KICK).success[0]


@pytest.mark.parametrize("kind", GOALKEEPER_KINDS)
def test_a_fast_goalkeeper_stops_more_than_a_slow_one(kind: str) -> None:
    rng, goals = np.random.default_rng(1), []
    aims = rng.uniform(-0.45, 0.45, 60)
    places = rng.uniform((-0.5, -1.5), (1.5, 1.5), (60, 2))
    headings = np.arctan2(aims - places[:, 1], 4.5 - places[:, 0])
    for speed in (0.3, 3.0):
        shots = [
            start((*place, heading), kind=kind, speed=speed)
            for place, heading in zip(places.tolist(), headings.tolist(), strict=True)
        ]
        made = ScoreOnGoalkeeperTask(n=60)
        goals.append(run_starts(made, lambda seen: np.tile(KICK, (len(seen), 1)), shots).success.sum())
    slow, fast = goals
    assert slow > fast + 8


def test_the_shipped_goalkeeper_is_the_shipped_goalkeeper() -> None:
    made = ScoreOnGoalkeeperTask(n=6, seed=2)
    rows = made.sample_starts(3, 6)
    rows[:, 16], rows[:, 17] = [SHIPPED, 0, SHIPPED, 1, 2, SHIPPED], [3.0, 3.0, 1.5, 3.0, 3.0, 2.0]
    made.reset_to(rows, seed=0)
    settings, theirs = made.settings, np.flatnonzero(rows[:, 16] == SHIPPED)
    alone = Goalkeepers(settings.field, settings.simulator.limits, settings.period, 6, rows[:, 17] / 3.0)
    wanted, rng = np.zeros((6, 6)), np.random.default_rng(0)
    for _ in range(40):
        arenas = made.arenas
        alone.decide(arenas.robots, arenas.balls, arenas.contact, 1, wanted)
        made.oppose(made._commands)
        np.testing.assert_array_equal(made._commands[theirs, 1, :6], wanted[theirs])
        made._commands[:, 0, :3] = rng.uniform(-1.0, 1.0, (6, 3))
        arenas.step(made._commands)


def test_a_kick_is_worth_what_the_goalkeeper_cannot_reach() -> None:
    weights, field = ScoreReward(), ScoreOnGoalkeeperSettings().field

    def worth(y: float, vy: float = 0.0) -> float:
        return kicked(weights, field, RobotState(0, 4.3, y, 0.0), BallState(2.5, 0.0, 6.0, vy))

    assert worth(0.0) == weights.aimed
    # 1.8 m at 6 m/s are 0.3 s, in which 6 m/s^2 take it 0.27 m: a shot as far beside its hull is in doubt.
    in_doubt = weights.aimed + weights.doubt * weights.unreached
    assert worth(0.09 + 0.0215 + 0.27) == pytest.approx(in_doubt)
    assert worth(0.09 + 0.0215 + 0.27 + 0.1) == pytest.approx(in_doubt + weights.unreached / 3)
    assert worth(2.0) == weights.aimed + weights.unreached
    assert worth(0.0, vy=6.0) == -weights.miss


def test_driving_to_the_ball_pays_by_the_metre_and_a_shot_costs_nothing_of_it() -> None:
    made = task(start((0.0, 0.0, 0.0), ball=(2.0, 0.0, 0.0, 0.0)))
    ahead = np.array([[1.0, 0.0, 0.0, -1.0]])
    paid = sum(float(made.advance(ahead).reward[0]) for _ in range(10))
    way = float(made.arenas.robots[0, 0, 0])
    weights = made.settings.reward
    # From the second tick on: the first one says what there is to start with.
    # It is nearer to ball and goal alike.
    expected = (weights.approach + weights.advance) * way
    assert paid + 20 * weights.time == pytest.approx(expected, abs=0.02)


@pytest.mark.parametrize(
    ("name", "row", "action"),
    [
        ("out", start((0.0, 2.5, np.pi / 2)), KICK),
        ("held by the goalkeeper", start((-4.0, 2.5, 0.0), ball=(4.2535, 0.0, 0.0, 0.0)), STAY),
        ("at rest in the area", start((-4.0, 2.5, 0.0), ball=(4.0, 0.8, 0.0, 0.0), speed=0.01), STAY),
        ("with the ball in the area", start((3.2, 0.9, 0.0)), np.array([0.5, 0.0, 0.0, -1.0])),
        ("in the area", start((3.2, 0.0, 0.0), ball=(0.0, 0.0, 0.0, 0.0)), np.array([1.0, 0.0, 0.0, -1.0])),
    ],
)
def test_how_an_attack_is_lost(name: str, row: list[float], action: np.ndarray) -> None:
    made = task(row)
    result = to_the_end(made, action)
    assert result.terminated[0], name
    assert not result.success[0]
    assert result.reward[0] < -0.8 * made.settings.reward.lost


def test_a_shot_that_the_goalkeeper_has_saved_can_be_the_last() -> None:
    row = start((1.0, 0.0, 0.0), kind="line")
    goes_on, ends = (task(row, saved=saved, held_by_keeper=1000) for saved in (False, True))
    assert not to_the_end(ends, KICK).success[0]
    to_the_end(goes_on, KICK)
    assert ends.ended is not None
    assert goes_on.ended is not None
    assert ends.ended.ticks[0] < 0.5 * goes_on.ended.ticks[0]


def test_the_rules_dribbling_limit_can_be_kept() -> None:
    slowly = np.array([0.3, 0.0, 0.0, -1.0])
    kept = task(start((0.0, 0.0, 0.0)), dribbling=1.0)
    result = to_the_end(kept, slowly)
    assert result.terminated[0]
    assert kept.arenas.balls[0, 0] == pytest.approx(1.0 + HELD, abs=0.1)


def test_it_is_the_same_in_a_match() -> None:
    made = ScoreOnGoalkeeperTask(ScoreOnGoalkeeperSettings(decide_every=1))
    me, keeper = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)
    settings = made.settings
    for seed in range(3):
        row = made.sample_starts(seed, 1)[0]
        row[14:16] = 0.0
        seen = made.reset_to(row, seed=0)
        limits = {me: settings.robot_limits, keeper: settings.simulator.limits}
        world = SimWorld(settings.field, limits, settings.stepped_simulator, settings.period)
        poses = {me: tuple(row[:3]), keeper: tuple(row[6:9])}
        world.reset(Placement(poses, (*row[12:14], 0.0, 0.0)), seed=0)
        rng = np.random.default_rng(seed)
        for _ in range(40):
            frame = world.observe()
            found = score_on_goalkeeper_of(frame, frame.own[0])
            np.testing.assert_allclose(found, seen[0], rtol=0, atol=1e-9)
            action = rng.uniform(-1, 1, 4) - [0, 0, 0, 0.9]
            seen = made.advance(action[None]).observation
            world.act({me: command_of(action, made.action), keeper: _command(made._commands[0, 1])})


def _command(row: np.ndarray) -> Any:
    from robobt.world import RobotCommand

    vx, vy, omega, *_, dribbler = row[:6].tolist()
    return RobotCommand(vx, vy, omega, dribbler=bool(dribbler))


def test_its_script_scores() -> None:
    made = ScoreOnGoalkeeperTask(n=64)
    script = made.script()
    assert script is not None
    assert run_starts(made, script, made.sample_starts(2, 64)).success.mean() > 0.3
