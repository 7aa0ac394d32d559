"""Tasks of several robots: who plays, what each sees and earns, and how they end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import run_starts
from robobt.learning.envs.central import central_view
from robobt.learning.envs.per_robot import PerRobot
from robobt.learning.envs.soccer.settings import SoccerRules, SoccerSettings
from robobt.learning.envs.soccer.suite import SUITE, instead, scripted
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.opponents.play_settings import PlaySettings

HELD = 0.0968
SUITED = pytest.mark.parametrize("name", SUITE)
STAY, KICK = [0.0, 0.0, 0.0, -1.0], [0.0, 0.0, 0.0, 1.0]


def at(x: float, y: float, heading: float = 0.0) -> list[float]:
    return [x, y, heading, 0.0, 0.0, 0.0]


def in_mouth(x: float, y: float, heading: float = 0.0) -> list[float]:
    return [x + HELD * np.cos(heading), y + HELD * np.sin(heading), 0.0, 0.0]


def playing(start: list[float], **settings: Any) -> SoccerTask:
    made = SoccerTask(SoccerSettings.model_validate(settings))
    made.reset_to(start, seed=0)
    return made


def to_the_end(made: SoccerTask, *actions: list[float]) -> Any:
    total = np.zeros(len(actions))
    for _ in range(400):
        result = made.advance(np.concatenate(actions)[None])
        total += made.shares[0]
        if made.ended is not None:
            return result, total
    raise AssertionError("no episode has ended")


def everybody_still(blue: int, yellow: int) -> dict[str, Any]:
    return {"blue": ["learner"] * blue, "yellow": ["learner"] * yellow}


def test_a_goal_is_earned_by_one_team_and_paid_for_by_the_other() -> None:
    start = [*at(2, 0), *at(1, 1), *at(3, 1.5, 2), *in_mouth(2, 0)]
    made = playing(start, **everybody_still(2, 1), reward={"approach": 0.0})
    result, earned = to_the_end(made, KICK, STAY, STAY)
    assert result.success[0]
    weights = made.settings.reward
    assert earned[0] > earned[1] > weights.goal
    assert earned[2] < -weights.goal
    # The one who shot has earned that besides.
    assert earned[0] - earned[1] == pytest.approx(weights.shot)
    shared = playing(start, **everybody_still(2, 1), reward={"approach": 0.0, "shared": 1.0})
    _, even = to_the_end(shared, KICK, STAY, STAY)
    assert even[0] == pytest.approx(even[1])
    assert even[0] + even[1] == pytest.approx(earned[0] + earned[1])


def test_nobody_lives_on_shots_at_the_goalkeeper() -> None:
    nothing = dict.fromkeys(("approach", "advance", "goal", "fault", "time", "crash"), 0.0)
    made = playing([*at(2, 0), *in_mouth(2, 0)], blue=["learner"], reward={**nothing, "shot": 1.0})
    earned, kicks = 0.0, 0
    for _ in range(40):
        made.arenas.place([[at(2, 0)]], [in_mouth(2, 0)])
        made.advance(np.array([KICK]))
        kicks += int(made.arenas.balls[0, 2] > 3.0)
        earned += made.shares[0, 0]
    assert kicks > 4
    assert earned == pytest.approx(4.0)


@pytest.mark.parametrize(
    ("mate", "opponent", "earned"),
    [
        (at(3.5, 0), at(3, 1.5), 1.0),
        (at(3.5, 0.2), at(3, 1.5), 0.5),  # half of how far beside a mate a pass may come
        (at(3.5, 0), at(2.8, 0.1), 0.0),  # an opponent is on the way
        (at(2.5, 0.3), at(3, 1.5), 0.0),  # too near to be passed to
    ],
)
def test_a_kick_at_a_mate_is_earned_by_who_kicks(
    mate: list[float], opponent: list[float], earned: float
) -> None:
    start = [*at(2, 0), *mate, *opponent, *in_mouth(2, 0)]
    nothing = dict.fromkeys(("approach", "advance", "shot", "goal", "fault", "time", "crash"), 0.0)
    made = playing(start, **everybody_still(2, 1), reward={**nothing, "sent": 2.0})
    made.advance(np.concatenate((KICK, STAY, STAY))[None])
    np.testing.assert_allclose(made.shares[0], (2.0 * earned, 0.0, 0.0), atol=0.02)


def test_what_two_in_each_others_place_see_and_earn_is_the_same() -> None:
    rng = np.random.default_rng(3)
    rows = rng.uniform(-2.0, 2.0, (20, 4, 6))
    turned = rows[:, [2, 3, 0, 1]] * [-1, -1, 1, -1, -1, 1]
    turned[..., 2] += np.pi
    balls = rng.uniform(-2.0, 2.0, (20, 4))
    made = SoccerTask(SoccerSettings.model_validate(everybody_still(2, 2)))
    seen = made.observe(rows, balls).reshape(20, 4, -1)
    other = made.observe(turned, -balls).reshape(20, 4, -1)
    np.testing.assert_allclose(seen, other[:, [2, 3, 0, 1]], atol=1e-9)


def test_mates_and_opponents_are_seen_nearest_first_with_their_velocities() -> None:
    made = SoccerTask(SoccerSettings.model_validate(everybody_still(3, 2)))
    robots = np.array([[at(0, 0, np.pi / 2), at(2, 0), at(0, 1), at(-1, 0), at(-3, 0)]])
    robots[0, 2, 3:5] = 0.5, 0.0
    seen = made.observe(robots, np.zeros((1, 4))).reshape(5, -1)[0]
    names = dict(zip([entry.name for entry in made.observation.entries], seen, strict=True))
    assert [names["mate_0_x"], names["mate_0_y"]] == pytest.approx([1, 0])
    assert [names["mate_0_vx"], names["mate_0_vy"]] == pytest.approx([0, -0.5])
    assert [names["mate_1_x"], names["mate_1_y"]] == pytest.approx([0, -2])
    assert [names["opponent_0_x"], names["opponent_0_y"]] == pytest.approx([0, 1])
    assert [names["opponent_1_x"], names["opponent_1_y"]] == pytest.approx([0, 3])
    # Yellow has one mate and three opponents: a place is left.
    left = made.observe(robots, np.zeros((1, 4))).reshape(5, -1)[3]
    names = dict(zip([entry.name for entry in made.observation.entries], left, strict=True))
    assert names["mate_1_x"] == -5.0
    assert names["opponent_2_x"] == pytest.approx(3.0)


@SUITED
def test_arenas_of_a_task_follow_from_the_seed_and_their_index(name: str) -> None:
    one, many = (SoccerTask(SUITE[name](), n, seed=4) for n in (1, 5))
    assert (one.reset()[0] == many.reset()[0]).all()
    rng = np.random.default_rng(2)
    for _ in range(60):
        actions = rng.uniform(-1.0, 1.0, (5, many.action_size))
        alone, among = one.step(actions[:1]), many.step(actions)
        np.testing.assert_array_equal(alone.observation[0], among.observation[0])
        np.testing.assert_array_equal(one.shares[0], many.shares[0])
    assert np.isfinite(many.state()).all()


@SUITED
def test_starts_are_in_their_ranges_and_apart(name: str) -> None:
    made = SoccerTask(SUITE[name]())
    settings, rows = made.settings, made.sample_starts(1, 100)
    robots = rows[:, : 6 * made.robots].reshape(100, made.robots, 6)
    away = np.linalg.norm(robots[:, :, None, :2] - robots[:, None, :, :2], axis=-1) + 9 * np.eye(made.robots)
    assert away.min() >= settings.starts.apart
    for index, role in enumerate(settings.roles):
        if role != "goalkeeper":
            low, high = settings.starts.blue_x if index < len(settings.blue) else settings.starts.yellow_x
            assert (robots[:, index, 0] >= low).all()
            assert (robots[:, index, 0] <= high).all()


@pytest.mark.integration
@pytest.mark.parametrize(
    "name", ["ScoreOnGoalkeeperAndDefenders", "Save", "DuelWithScript", "Keepaway", "Pass", "Attack3v2"]
)
def test_the_script_can_do_what_the_task_asks_but_not_always(name: str) -> None:
    made = SoccerTask(scripted(SUITE[name]()), 60)
    episodes = run_starts(made, lambda seen: np.zeros((len(seen), 0)), made.sample_starts(9, 60))
    assert 0.0 < episodes.success.mean() < 0.6


def test_a_play_in_the_learners_places_starts_where_they_do_and_meets_who_they_meet() -> None:
    settings = SoccerSettings(
        blue=("learner", "play"), yellow=("play", "goalkeeper"), plays=("stand_still", "attack_main")
    )
    mine = instead(settings, PlaySettings(play="attack_expected"))
    assert (mine.blue, mine.yellow) == (("play", "play"), ("play", "goalkeeper"))
    assert [one.play for one in mine.plays] == ["attack_expected", "stand_still", "attack_main"]
    task, theirs = SUITE["Save"](), instead(SUITE["Save"](), PlaySettings(play="team_goalkeeper"))
    starts = [SoccerTask(each).sample_starts(5, 10) for each in (task, theirs)]
    np.testing.assert_array_equal(*starts)


def test_a_goalkeeper_starts_in_its_goal_by_its_role_and_by_its_play() -> None:
    by_role = SoccerSettings(yellow=("goalkeeper", "wall"))
    by_play = SoccerSettings(yellow=("play", "wall"), plays=("team_goalkeeper",))
    for settings in (by_role, by_play):
        made = SoccerTask(settings)
        keeper, other = made.sample_starts(3, 50)[:, 6:18].reshape(50, 2, 6).transpose(1, 0, 2)
        assert (keeper[:, 0] > made.settings.field.half_length - 0.61).all()
        np.testing.assert_array_equal(keeper[:, 1:3], np.tile([0.0, np.pi], (50, 1)))
        assert (other[:, 0] <= settings.starts.yellow_x[1]).all()


def test_a_pass_counts_when_it_comes_to_a_mate() -> None:
    start = [*at(0, 0), *at(1.5, 0, np.pi), *in_mouth(0, 0)]
    made = playing(start, blue=["learner", "still"], aim="pass", action={
        "kind": "drive_and_kick", "max_speed": 3.0, "max_turn": 6.0, "kick_speed": 1.35, "dribbler": True,
    }, reward={"passed": 3.0})  # fmt: skip
    result, earned = to_the_end(made, KICK)
    assert result.success[0]
    assert earned[0] > 2.5
    assert made.arenas.contact[0, 1]


@pytest.mark.parametrize(
    ("changes", "start", "action"),
    [
        ({}, [*at(2.9, 0), *at(-3, 2), *in_mouth(2.9, 2)], [1.0, 0.0, 0.0, -1.0]),
        ({}, [*at(0, 0), *at(1, 0, np.pi), *in_mouth(1, 0, np.pi)], STAY),
        ({"rules": {"dribbling": 0.4}}, [*at(0, 0), *at(-3, 2), *in_mouth(0, 0)], [0.4, 0.0, 0.0, -1.0]),
        ({}, [*at(0, 2.5, np.pi / 2), *at(-3, 2), *in_mouth(0, 2.5, np.pi / 2)], KICK),
    ],
    ids=["in the area", "taken by yellow", "carried too far", "out"],
)
def test_how_blue_loses(changes: dict[str, Any], start: list[float], action: list[float]) -> None:
    made = playing(start, yellow=["still"], **changes)
    result, earned = to_the_end(made, action)
    assert result.terminated[0]
    assert not result.success[0]
    assert earned[0] < -0.4


def test_a_ball_that_was_let_go_is_carried_anew() -> None:
    made = playing(
        [*at(0, 0), *at(-3, 2), *in_mouth(0, 0)],
        yellow=["still"],
        rules={"dribbling": 0.4},
        action={
            "kind": "drive_and_kick",
            "max_speed": 3.0,
            "max_turn": 6.0,
            "kick_speed": 1.0,
            "dribbler": True,
        },
    )
    made.advance(np.array([KICK]))
    assert not made.arenas.contact[0, 0]
    while not made.arenas.contact[0, 0] and made.ended is None:
        made.advance(np.array([[0.3, 0.0, 0.0, -1.0]]))
    taken = made.arenas.balls[0, 0]
    assert taken > HELD + 0.4
    assert made.ended is None
    to_the_end(made, [0.4, 0.0, 0.0, -1.0])
    assert made.arenas.balls[0, 0] - taken == pytest.approx(0.4, abs=0.1)


def test_a_learner_is_made_to_let_go_of_a_ball() -> None:
    rules = {"dribbling": 0.5, "let_go": 0.4}
    made = playing([*at(-2, 0), *at(-3, 2), *in_mouth(-2, 0)], yellow=["still"], rules=rules, time_limit=60)
    while made.ended is None:
        made.advance(np.array([[0.35, 0.0, 0.0, -1.0]]))
    assert made.ended.truncated[0]
    assert made.arenas.balls[0, 0] - made.arenas.robots[0, 0, 0] > 0.3


def test_a_ball_has_to_be_let_go_of_before_it_was_carried_too_far() -> None:
    with pytest.raises(ValueError, match=r"let_go: 1 m is too late, dribbling allows 1 m"):
        SoccerRules(dribbling=1.0, let_go=1.0)


@pytest.mark.parametrize(("aim", "won"), [("hold", True), ("score", False)])
def test_a_ball_held_for_long_is_received_or_no_redirection(aim: str, won: bool) -> None:
    start = [*at(0, 0), *at(-3, 2), *in_mouth(0, 0)]
    rules = {"hold": 6} if won else {"longest_hold": 6}
    made = playing(start, yellow=["still"], aim=aim, rules=rules)
    result, _ = to_the_end(made, STAY)
    assert result.terminated[0]
    assert result.success[0] == won
    assert made.ended is not None
    assert 6 <= made.ended.ticks[0] <= 8


def test_a_ball_that_comes_rolls_near_by_who_is_to_take_it() -> None:
    rows = SoccerTask(SUITE["Receive"]()).sample_starts(2, 300)
    way, velocity = rows[:, :2] - rows[:, 12:14], rows[:, 14:16]
    fast = np.hypot(*velocity.T)
    assert (way * velocity).sum(1).min() > 0.0
    assert (np.abs(way[:, 0] * velocity[:, 1] - way[:, 1] * velocity[:, 0]) / fast).max() < 0.22
    assert fast.min() >= 1.5


def test_either_team_may_hold_the_ball_at_the_start() -> None:
    starts = {"held": 1.0, "holder": "either"}
    made = SoccerTask(SUITE["Duel"].model_validate({"starts": starts}))
    rows = made.sample_starts(4, 200)
    away = np.hypot(rows[:, [0, 6]] - rows[:, [12]], rows[:, [1, 7]] - rows[:, [13]])
    assert (away.min(1) < 0.12).all()
    assert 60 < (away[:, 0] < 0.12).sum() < 140


def test_to_hold_out_is_a_success_and_a_truncation() -> None:
    start = [*at(0, 0), *at(-3, 2), *in_mouth(0, 0)]
    made = playing(start, yellow=["still"], aim="keep", time_limit=10)
    result, _ = to_the_end(made, STAY)
    assert result.truncated[0]
    assert result.success[0]


def test_every_learner_has_a_row_of_its_own() -> None:
    settings = SoccerSettings.model_validate(everybody_still(2, 1))
    rows, whole = PerRobot(SoccerTask(settings, 3, seed=1)), SoccerTask(settings, 3, seed=1)
    np.testing.assert_array_equal(rows.reset(), whole.reset().reshape(9, -1))
    actions = np.random.default_rng(0).uniform(-1, 1, (9, 4))
    result, same = rows.step(actions), whole.step(actions.reshape(3, -1))
    np.testing.assert_array_equal(result.reward, whole.shares.ravel())
    np.testing.assert_allclose(result.reward.reshape(3, 3).mean(1), same.reward)
    with pytest.raises(ValueError, match=r"\(9, 4\)"):
        rows.step(actions[:4])


def test_a_central_critic_sees_every_robot_as_each_team_does() -> None:
    rng = np.random.default_rng(5)
    robots, balls = rng.uniform(-2.0, 2.0, (4, 5, 6)), rng.uniform(-2.0, 2.0, (4, 4))
    seen = central_view(robots, balls, (0, 1, 2, 3, 4), 3, 3, 3)
    assert seen.shape == (4, 5, 7 * 6 + 4)
    # It is told the same of each robot of a team; of whom it is asked, what that one observes tells.
    np.testing.assert_array_equal(seen[:, 0], seen[:, 2])
    places = seen[:, :, :-4].reshape(4, 5, 6, 7)
    np.testing.assert_array_equal(places[:, 0, 3:5, :2], robots[:, 3:, :2])
    np.testing.assert_array_equal(places[:, 3, 3:, :2], -robots[:, :3, :2])
    np.testing.assert_array_equal(places[:, 3, :2, 6], robots[:, 3:, 5])
    np.testing.assert_array_equal(seen[:, 4, -4:], -balls)
    assert (places[:, 0, 5] == [-5.0, 0, 0, 0, 0, 0, 0]).all()
    # In each other's place both teams are told the same.
    turned = robots[:, [3, 4, 0, 1, 2]] * [-1, -1, 1, -1, -1, 1]
    turned[..., 2] += np.pi
    swapped = central_view(turned, -balls, (2, 0), 2, 3, 3)
    np.testing.assert_allclose(swapped, seen[:, [0, 3]], atol=1e-12)


def test_the_state_that_an_episode_ended_in_is_told_before_the_next_begins() -> None:
    settings = SoccerSettings.model_validate({**everybody_still(2, 1), "time_limit": 2})
    told, rows = (PerRobot(SoccerTask(settings, 3, seed=1), central) for central in (True, False))
    own = rows.observation_size
    np.testing.assert_array_equal(told.reset()[:, :own], rows.reset())
    result, same = (made.step(np.zeros((9, 4))) for made in (told, rows))
    assert result.truncated.all()
    for field in ("observation", "final_observation"):
        seen = getattr(result, field)
        np.testing.assert_array_equal(seen[:, :own], getattr(same, field))
        # Where it is on the field is told twice.
        np.testing.assert_array_equal(seen[::3, 3:5], seen[::3, own : own + 2])
        np.testing.assert_array_equal(seen[2::3, 3:5], seen[2::3, own : own + 2])
    assert (result.observation != result.final_observation).any()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"blue": ["attack"]}, "nobody is a learner"),
        ({"yellow": ["goalkeeper"] * 2}, "one goalkeeper"),
        ({"aim": "pass"}, "to pass takes two"),
        ({"blue": ["learner", "goalkeeper"]}, "nobody to mind"),
    ],
)
def test_teams_that_make_no_task_are_refused(given: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        SoccerSettings.model_validate(given)
