"""The league's restarts in tasks of several robots, beside the match's own referee."""

from __future__ import annotations

import itertools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import make_task
from robobt.learning.envs.soccer.judge import StopReason
from robobt.learning.envs.soccer.settings import SoccerRules, SoccerSettings, SoccerStarts
from robobt.learning.envs.soccer.suite import SUITE, instead, scripted
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.match.referee.automatic import AutomaticReferee
from robobt.match.referee.events import EventKind
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.models.card import ObservationCard
from robobt.skills import LearnedSkill
from robobt.world import BallState, Frame, RobotId, RobotState, Team
from robobt.world.rules import STOP_DISTANCE, in_their_defense_area
from robobt.world.state import ROBOT_RADIUS
from robobt.world.team_view import team_view_of
from tests.learning.envs.test_soccer import KICK, STAY, at, in_mouth
from tests.models.made_models import network, team_card, write_model
from tests.skills.fixed_world import Alone

UP = np.pi / 2
BOTH = {"restarts": True, "double_touch": True}


class Watched:
    """An arena with restarts, and its frames as a referee sees them, before the ball is put elsewhere."""

    def __init__(self, start: list[float], blue: int = 1, yellow: int = 1, **changes: Any) -> None:
        given = {"blue": ["learner"] * blue, "yellow": ["learner"] * yellow, "rules": BOTH, "decide_every": 1}
        self.task = SoccerTask(SoccerSettings.model_validate(given | changes))
        self.task.reset_to(start, seed=0)
        self.frames: list[Frame] = []
        judge = self.task._judge

        def watching(*args: Any) -> bool:
            self.frames.append(self.frame())
            return judge(*args)

        self.task._judge = watching  # type: ignore[method-assign]

    def frame(self) -> Frame:
        task = self.task
        robots = [RobotState(k, *row) for k, row in enumerate(task.arenas.robots[0].tolist())]
        blue = robots[: task.blue]
        yellow = [RobotState(r.id - task.blue, r.x, r.y, r.heading, r.vx, r.vy, r.omega) for r in robots][
            task.blue :
        ]
        for team, first in ((blue, 0), (yellow, task.blue)):
            for k, robot in enumerate(team):
                robot.ball_contact = bool(task.arenas.contact[0, first + k])
        touch = int(task.arenas.touch[0])
        team_of = Team.BLUE if touch < task.blue else Team.YELLOW
        last = RobotId(team_of, touch if touch < task.blue else touch - task.blue)
        return Frame(
            0.03 * len(self.frames),
            task.settings.field,
            BallState(*task.arenas.balls[0].tolist()),
            tuple(blue),
            tuple(yellow),
            period=0.03,
            game=task.game(0),
            last_touch=last if touch >= 0 else None,
        )

    @property
    def row(self) -> Any:
        return self.task._restarts.states[0]

    def play(self, *actions: list[float], until: Any, ticks: int = 400) -> Any:
        """Go on until something is so; nothing may end the episode before."""
        for _ in range(ticks):
            result = self.task.advance(np.concatenate(actions)[None])
            assert self.task.ended is None
            if until():
                return result
        raise AssertionError("it has not come to that")


@pytest.mark.parametrize(
    ("start", "spot"),
    [
        ([*at(0.7, 2.5, UP), *at(-3, 2), *in_mouth(0.7, 2.5, UP)], None),
        ([*at(4.0, 1.9), *at(-3, 2), *in_mouth(4.0, 1.9)], (3.5, 2.8)),
        ([*at(-4.0, -1.9, np.pi), *at(3, 2), *in_mouth(-4.0, -1.9, np.pi)], (-4.3, -2.8)),
    ],
    ids=["touch line", "their goal line", "own goal line"],
)
def test_the_ball_is_put_where_the_matchs_referee_puts_it(start: list[float], spot: Any) -> None:
    seen = Watched(start)
    made, before = seen.task, seen.task.shares
    seen.play(KICK, STAY, until=lambda: seen.row["team"] != 0)
    assert seen.row["team"] == -1
    referee = Referee(made.settings.field, RefereeSettings(opening="force_start", aimless_kick=False))
    games = [referee.update(frame).game for frame in seen.frames]
    assert all(game.in_play for game in games[:-1])
    placed, told = made.arenas.balls[0, :2], made.game(0)
    assert games[-1].placement == told.placement == tuple(placed)
    assert games[-1].restart_team is told.restart_team is Team.YELLOW
    if spot is not None:
        assert told.placement == pytest.approx(spot)
    else:
        assert 3.0 - abs(placed[1]) == pytest.approx(0.2)
    # It lies still, nobody drives, and who has put it out has paid for that.
    assert not made.arenas.balls[0, 2:].any()
    assert not made.arenas.robots[0, :, 3:].any()
    assert before is not made.shares
    assert made.shares[0, 0] < -0.5 < 0.5 < made.shares[0, 1]
    away = np.hypot(*(made.arenas.robots[0, 0, :2] - placed))
    assert away >= STOP_DISTANCE + ROBOT_RADIUS


def thrown_in(mine: list[float], *others: list[float], **changes: Any) -> Watched:
    """Blue's free kick at (0, 2.8): yellow's first robot, at (0, 2.5), has put the ball out."""
    yellow = [*at(0, 2.5, UP), *(number for other in others for number in other)]
    seen = Watched([*mine, *yellow, *in_mouth(0, 2.5, UP)], yellow=1 + len(others), **changes)
    seen.play(STAY, KICK, *[STAY] * len(others), until=lambda: seen.row["team"] != 0)
    assert seen.row["team"] == 1
    return seen


PUSH = [0.3, 0.0, 0.0, -1.0]


def test_who_pushes_the_ball_on_touches_it_twice() -> None:
    seen = thrown_in(at(0, 2.3, UP))
    seen.play(PUSH, STAY, until=lambda: seen.row["team"] == -1)
    assert seen.task.game(0).placement == pytest.approx((0.0, 2.8))
    assert seen.task.shares[0, 0] < -0.5
    # The match's referee says so in the same tick, and not before.
    referee = AutomaticReferee(seen.task.settings.field)
    told = [{event.kind for event in referee.watch(frame, frame.game)} for frame in seen.frames]
    double = [EventKind.ATTACKER_DOUBLE_TOUCHED_BALL in kinds for kinds in told]
    assert double == [False] * (len(told) - 1) + [True]


def test_it_may_do_so_where_that_is_no_rule() -> None:
    seen = thrown_in(at(0, 2.3, UP), rules={"restarts": True})
    seen.play(PUSH, STAY, until=lambda: seen.row["team"] == 0)
    seen.play(PUSH, STAY, until=lambda: seen.row["team"] != 0)
    assert seen.frames[-1].ball.y > 3.0


def test_who_has_kicked_it_may_touch_it_once_another_has() -> None:
    seen = thrown_in(at(-0.3, 2.8), at(1.5, 2.8, np.pi))
    seen.play([*PUSH[:3], 1.0], STAY, STAY, until=lambda: seen.row["taker"] == 0)
    assert seen.task.state()[0, -2:].tolist() == [0.0, 0.0]
    seen.play(STAY, STAY, STAY, until=lambda: seen.task.arenas.touch[0] == 2)
    assert seen.row["taker"] == -1
    seen.task.arenas.place_ball(0, *seen.task.arenas.robots[0, 0, :2] + [0.0968, 0.0])
    seen.play(STAY, STAY, STAY, until=lambda: seen.task.arenas.touch[0] == 0)
    assert seen.row["team"] == 0


def test_an_opponent_that_comes_near_is_put_back_and_pays_for_it_every_two_seconds() -> None:
    seen = thrown_in(at(-2, 0))
    made, paid, nearest = seen.task, [], np.inf
    for tick in range(150):
        made.advance(np.concatenate([STAY, [1.0, 0.0, 0.0, -1.0]])[None])
        nearest = min(nearest, np.hypot(*(made.arenas.robots[0, 1, :2] - [0.0, 2.8])))
        if made.shares[0, 1] < -0.5:
            paid.append(tick)
            assert made.shares[0, 0] > 0.5
            assert seen.row["left"] == 333
        assert seen.row["team"] == 1
    assert nearest > STOP_DISTANCE + ROBOT_RADIUS - 0.02
    # It has to drive there again each time.
    assert [late - early for early, late in itertools.pairwise(paid)] == [pytest.approx(70, abs=3)] * 2
    assert made.arenas.balls[0, :2] == pytest.approx([0.0, 2.8], abs=1e-6)


def test_a_restart_that_nobody_takes_is_over_after_the_rules_time() -> None:
    seen = thrown_in(at(-2, 0), time_limit=1000)
    began = len(seen.frames)
    seen.play(STAY, STAY, until=lambda: seen.row["team"] == 0)
    assert 0.03 * (len(seen.frames) - began) == pytest.approx(10.0, abs=0.03)
    assert seen.row["taker"] == -1
    assert seen.task.game(0).in_play


@pytest.mark.parametrize(
    ("rules", "start", "action", "spot"),
    [
        ({"dribbling": 0.4}, [*at(0, 0), *at(-3, 2), *in_mouth(0, 0)], [0.4, 0.0, 0.0, -1.0], (0.0968, 0.0)),
        ({}, [*at(2.9, 0), *at(-3, 2), 1.0, 2.0, 0.0, 0.0], [1.0, 0.0, 0.0, -1.0], (1.0, 2.0)),
    ],
    ids=["carried too far", "in the area"],
)
def test_other_faults_are_the_others_free_kick(
    rules: dict[str, Any], start: list[float], action: list[float], spot: tuple[float, float]
) -> None:
    seen = Watched(start, rules=BOTH | rules)
    seen.play(action, STAY, until=lambda: seen.row["team"] != 0)
    assert seen.task.game(0).restart_team is Team.YELLOW
    assert seen.task.game(0).placement == pytest.approx(spot, abs=2e-3)
    assert seen.task.shares[0, 0] < -0.5
    x, y = seen.task.arenas.robots[0, 0, :2]
    assert not in_their_defense_area(seen.task.settings.field, x, y)


def test_what_happens_in_an_arena_still_depends_on_its_seed_alone() -> None:
    rules = {**BOTH, "held_by": None}
    starts, changes = {"ball_speed": (3.0, 5.0)}, {"velocities": "finite_difference", "latency": 1}
    settings = SUITE["Small3v3"].model_validate({"rules": rules, "starts": starts, **changes})
    one, many = (SoccerTask(settings, n, seed=4) for n in (1, 6))
    space = make_task(settings, 1).space
    one.reset()
    many.reset()
    rng, restarts = np.random.default_rng(2), 0
    for _ in range(60):
        actions = rng.uniform(-1.0, 1.0, (6, many.action_size))
        alone, among = one.step(actions[:1]), many.step(actions)
        np.testing.assert_array_equal(alone.observation[0], among.observation[0])
        np.testing.assert_array_equal(one.shares[0], many.shares[0])
        restarts += int(one._restarts.stops.any())
        for mine in among.observation.astype(np.float32).reshape(24, -1):
            assert space.contains(mine)
    assert restarts > 0


@pytest.mark.parametrize(
    "settings",
    [
        SUITE["Small3v3"],
        lambda rules, time_limit: instead(
            SoccerSettings(
                blue=("learner", "pass"), yellow=("goalkeeper", "press", "challenge"), rules=rules,
                time_limit=time_limit, starts=SoccerStarts(ball_speed=(3.0, 5.0)),
            ),
            "pass",
        ),
    ],
    ids=["attackers", "others"],
)  # fmt: skip
def test_scripted_robots_take_their_restarts_and_leave_the_others_theirs(settings: Any) -> None:
    rules = SoccerRules(restarts=True, double_touch=True, held_by=None)
    made = SoccerTask(scripted(settings(rules=rules, time_limit=2000)), 8, seed=1)
    made.reset()
    states, taken, faults = made._restarts.states, 0, 0
    for _ in range(500):
        due, pause = states["team"] != 0.0, states["pause"].copy()
        made.step(np.zeros((8, 0)))
        over = due & (states["team"] == 0.0)
        taken += int(over.sum())
        assert (states["left"][over] > 100.0).all()
        faults += int((states["pause"] > pause).sum())
        assert not (made._restarts.stops == StopReason.TWICE).any()
    assert taken >= 4
    assert faults <= taken / 10


def test_a_double_touch_needs_restarts() -> None:
    with pytest.raises(ValueError, match="double_touch: there is nothing to touch twice without restarts"):
        SoccerRules(double_touch=True)


@pytest.mark.parametrize("double_touch", [True, False])
def test_a_skill_is_told_of_restarts_what_learners_are_told(tmp_path: Path, double_touch: bool) -> None:
    rules = {"restarts": True, "double_touch": double_touch}
    seen = thrown_in(at(0, 2.3, UP), rules=rules)
    made = seen.task
    places, told = made.settings.places, made.settings.rules.told
    card = team_card("LearnedSkill", *places, observation=ObservationCard.of(made.observation))
    model = write_model(tmp_path, network(made.observation.size, 4), card)
    leaves = [Alone(LearnedSkill(model=str(model))) for _ in Team]
    for leaf in leaves:
        leaf.store.draw.want({"observation"}, set())
    heard = set()
    for _ in range(60):
        result = made.advance(np.concatenate([PUSH, STAY])[None])
        frame = seen.frame()
        for leaf, mine, view in zip(
            leaves, result.observation.reshape(2, -1), (frame, frame.mirrored()), strict=True
        ):
            leaf.store.draw.take()
            leaf.tick(view)
            drawn = {name: value for _, _, value, name in leaf.store.draw.take()}
            names = [entry.name for entry in made.observation.entries]
            if drawn:
                assert [drawn[name] for name in names[-told:]] == mine[-told:].tolist()
            heard.add(tuple(mine[-told:]))
        barred = double_touch and leaves[0].store.team.kicker == 0
        own = team_view_of(frame, frame.own[0], *places, told, barred)
        np.testing.assert_array_equal(own, result.observation[0, : made.observation.size])
    assert {each[0] for each in heard} == {-1.0, 0.0, 1.0}
    assert ((0.0, 1.0) in heard) == double_touch


def test_shots_before_a_restart_count_after_it() -> None:
    nothing = dict.fromkeys(("approach", "advance", "goal", "fault", "time", "crash"), 0.0)
    given = {"blue": ["learner"], "rules": {"restarts": True}, "reward": {**nothing, "shot": 1.0}}
    task = SoccerTask(SoccerSettings.model_validate(given))
    task.reset_to([*at(2, 0), *in_mouth(2, 0)], seed=0)
    earned, stops = 0.0, 0
    for tick in range(60):
        task.arenas.place([[at(2, 0)]], [[2, 3.2, 0, 0] if tick % 10 == 9 else in_mouth(2, 0)])
        task.advance(np.array([KICK]))
        stops += int(2.5 < task.arenas.balls[0, 1] < 3.0)
        earned += task.shares[0, 0]
        assert task.ended is None
    assert stops > 2
    assert earned == pytest.approx(4.0)
