"""Compiled judging of tasks with several robots, over all arenas."""

from __future__ import annotations

from enum import IntEnum
from math import hypot, inf, isnan, nan, sqrt
from typing import NamedTuple, Protocol

from robobt.learning.envs.judging import (
    PROGRESS,
    EpisodeProgress,
    Ledger,
    Report,
    begin_tick,
    end_tick,
    goal_of,
    is_over,
)
from robobt.learning.envs.soccer.rewards import (
    REWARD_MEMORY,
    RewardMemory,
    SoccerReward,
    SoccerTerms,
    own_reward,
    sent,
    team_reward,
)
from robobt.learning.envs.soccer.settings import AIMS, SoccerRules, SoccerSettings
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.sim.records import Records
from robobt.world.compiled import Index, compilable, compiled_inline, compiled_lean, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.rules import in_area, is_out, keeps_ball
from robobt.world.state import ROBOT_RADIUS

_SCORE, _SAVE, _KEEP, _PASS, _HOLD = (AIMS.index(aim) for aim in ("score", "save", "keep", "pass", "hold"))


class StopReason(IntEnum):
    """Reasons for stopping play: ball out, carried too far, learner in the others' area, double touch."""

    NOTHING = 0
    OUT = 1
    CARRIED = 2
    IN_AREA = 3
    TWICE = 4


class Judged(Protocol):
    """Parameters for judging a tick: ``aim`` is an index in ``AIMS``; the first ``blue`` robots are blue."""

    settings: SoccerSettings
    field: FieldGeometry
    weights: SoccerReward
    rules: SoccerRules
    aim: Index
    blue: Index


class Mind(Protocol):
    """The state of an episode.

    Attributes:
        last: index of the last robot that held the ball, -1 for none.
        taken_x, taken_y: where the ball came into that mouth [m]; ``taken_x`` is nan once it was released.
        left_x, left_y: where the ball was last in that mouth [m].
        blue_ticks, yellow_ticks: ticks in a row for which each team has held the ball.
        goal: 1 for a goal by blue, -1 by yellow, 0 for none.
    """

    last: Index
    taken_x: float
    taken_y: float
    left_x: float
    left_y: float
    blue_ticks: float
    yellow_ticks: float
    goal: float


JUDGED, MIND, TERMS = record_dtype(Judged), record_dtype(Mind), record_dtype(SoccerTerms)


class JudgedPlay(NamedTuple):
    """Further arrays that judging reads and fills, for ``n`` arenas with L learners.

    ``fouls`` is the team that broke a rule of restarts, 1 blue, -1 yellow, 0 none, and ``stops`` the reason
    for stopping play without ending the episode; with restarts, judging then sets both for all other rules
    too.
    """

    who: IntArray  # (L,) indices of the learners
    kept: BoolArray  # (n,) whether the ball rests where it is yellow's goalkeeper's
    fouls: FloatArray  # (n,)
    stops: IntArray  # (n,) of Stop
    minds: FloatArray  # (n, size(MIND))
    memories: FloatArray  # (n, L, size(MEMORY))
    shares: FloatArray  # (n, L) rewards of the learners, added to


class _Arena(NamedTuple):
    """An arena after a tick."""

    judged: Judged
    who: IntArray
    robots: Records[Robot]  # (R,)
    ball: Ball
    contact: BoolArray  # (R,)
    kicked: BoolArray  # (R,)
    touch: int
    mind: Mind
    memories: Records[RewardMemory]  # (L,)
    terms: SoccerTerms


class _Course(NamedTuple):
    """The result of a tick: goal and fault (1 blue, -1 yellow, 0 none), and who has the ball."""

    goal: int
    fault: float
    holder: int  # -1 for nobody
    passed: bool


@compiled_lean
def judge(judged_: FloatArray, report_: Report, play_: JudgedPlay, ledger_: Ledger) -> bool:
    """Judge a tick of all arenas; return whether any episode has ended.

    Args:
        judged_: numbers of :class:`Judged`.
        report_: report of the arenas after the tick.
        play_: state of the arenas, updated.
        ledger_: bookkeeping of their episodes, updated.
    """
    judged: Judged = judged_.view(JUDGED)[0]
    arenas, play, ledger = Report(*report_), JudgedPlay(*play_), Ledger(*ledger_)
    robots, balls = arenas.robots.view(ROBOT)[..., 0], arenas.balls.view(BALL)[..., 0]
    minds, memories = play.minds.view(MIND)[..., 0], play.memories.view(REWARD_MEMORY)[..., 0]
    episodes, terms = ledger.progress.view(PROGRESS)[..., 0], ledger.terms.view(TERMS)[..., 0]
    rules, any_ended = judged.rules, False
    for i in range(len(balls)):
        if is_over(ledger, i):
            any_ended = True
            continue
        arena = _Arena(
            judged,
            play.who,
            robots[i],
            balls[i],
            arenas.contact[i],
            arenas.kicked[i],
            arenas.touch[i],
            minds[i],
            memories[i],
            terms[i],
        )
        episode: EpisodeProgress = episodes[i]
        begin_tick(episode, _any_learner_kicked(arena))
        goal = goal_of(episode, arena.ball, judged.field)
        arena.mind.goal = goal
        out = goal == 0 and is_out(
            arena.ball.x, arena.ball.y, judged.field.length / 2, judged.field.width / 2
        )
        holder, passed, too_far = _possession(arena)
        fault, stop = _fault(arena, out, holder, too_far, play.fouls[i], play.stops[i])
        lost = _has_lost(arena, play.kept[i])
        if lost:
            fault = 1.0
        # The team that ended the episode by a fault.
        ended = fault
        if rules.restarts:
            out, ended = False, 1.0 if lost else 0.0
            play.fouls[i], play.stops[i] = fault, StopReason.NOTHING if lost or goal != 0 else stop
        success, failed = _ends(arena, goal, out, ended, passed)
        mean = _reward(arena, _Course(goal, fault, holder, passed), play.shares[i])
        if end_tick(ledger, i, mean, success, failed, judged.settings.time_limit):
            any_ended = True
            # A team whose aim is to hold out succeeds when time is up.
            if ledger.truncated[i] and judged.aim in (_SAVE, _KEEP):
                ledger.success[i] = True
    return any_ended


@compiled_inline
def _any_learner_kicked(arena: _Arena) -> bool:
    fired = False
    for index in arena.who:
        fired = fired or arena.kicked[index]
    return fired


@compiled_inline
def _possession(arena: _Arena) -> tuple[int, bool, bool]:
    """Track the ball; return its holder (-1 for none), whether it was passed, and whether carried too far."""
    blue, rules, ball, mind = arena.judged.blue, arena.judged.rules, arena.ball, arena.mind
    holder = -1
    for r in range(len(arena.contact)):
        if arena.contact[r]:
            holder = r
    mind.blue_ticks = mind.blue_ticks + 1.0 if 0 <= holder < blue else 0.0
    mind.yellow_ticks = mind.yellow_ticks + 1.0 if holder >= blue else 0.0
    if holder < 0:
        for r in range(len(arena.kicked)):
            if arena.kicked[r]:
                # The robot had the ball, even if for less than a tick.
                mind.last, mind.left_x, mind.left_y = r, ball.x, ball.y
                mind.taken_x = nan
        if mind.last >= 0 and not keeps_ball(arena.robots[mind.last], ball):
            mind.taken_x = nan
        return holder, False, False
    last, passed = mind.last, False
    if holder != last:
        way = hypot(ball.x - mind.left_x, ball.y - mind.left_y)
        passed = 0 <= last < blue and holder < blue and way >= rules.pass_length
        mind.last = holder
    if holder != last or isnan(mind.taken_x):
        mind.taken_x, mind.taken_y = ball.x, ball.y
    mind.left_x, mind.left_y = ball.x, ball.y
    carried = hypot(ball.x - mind.taken_x, ball.y - mind.taken_y)
    return holder, passed, rules.dribbling is not None and carried > rules.dribbling


@compiled_inline
def _fault(
    arena: _Arena, out: bool, holder: int, too_far: bool, fault: float, stop: int
) -> tuple[float, int]:
    """Return the team that breaks a rule (1 blue, -1 yellow, 0 none), and the reason for stopping play.

    ``fault`` and ``stop`` come from the rules of restarts. If several rules are broken, the last counts.
    """
    blue, field = arena.judged.blue, arena.judged.field
    if out:
        stop = StopReason.OUT
        if arena.touch >= 0:
            fault = 1.0 if arena.touch < blue else -1.0
    if too_far:
        fault, stop = 1.0 if holder < blue else -1.0, StopReason.CARRIED
    if arena.judged.rules.areas:
        for index in arena.who:
            sign, robot = 1.0 if index < blue else -1.0, arena.robots[index]
            if in_area(
                sign * robot.x, sign * robot.y, field.length / 2, field.defense_depth, field.defense_width
            ):
                fault, stop = sign, StopReason.IN_AREA
    return fault, stop


@compiled_inline
def _has_lost(arena: _Arena, kept: bool) -> bool:
    """Return whether blue has held the ball for too long, or yellow for long enough."""
    rules, mind = arena.judged.rules, arena.mind
    if rules.longest_hold is not None and mind.blue_ticks > rules.longest_hold:
        return True
    return arena.judged.aim != _SAVE and (_at_least(mind.yellow_ticks, rules.held_by) or kept)


@compilable
def _at_least(ticks: float, most: int | None) -> bool:
    return most is not None and ticks >= most


@compiled_inline
def _ends(arena: _Arena, goal: int, out: bool, ended: float, passed: bool) -> tuple[bool, bool]:
    """Return whether the episode ends in success, by blue's aim, and whether it ends without.

    ``ended`` is the team that ended it by a fault: 1 blue, -1 yellow, 0 none.
    """
    aim, rules, mind = arena.judged.aim, arena.judged.rules, arena.mind
    if aim == _SAVE:
        success = goal > 0 or out or ended < 0.0 or _at_least(mind.blue_ticks, rules.held_by)
        failed = goal < 0 or ended > 0.0
        return success and not failed, failed
    failed = out or ended != 0.0 or goal < 0
    if aim == _SCORE:
        return goal > 0, failed
    success = False
    if aim == _PASS:
        success = passed and not failed
    elif aim == _HOLD:
        success = mind.blue_ticks >= rules.hold and not failed
    failed = failed or goal > 0
    return success and not failed, failed


@compiled_inline
def _reward(arena: _Arena, course: _Course, shares: FloatArray) -> float:
    """Add each learner's reward for a tick to ``shares`` (L,); return the mean."""
    blue, weights, field, ball = arena.judged.blue, arena.judged.weights, arena.judged.field, arena.ball
    half_length, learners = field.length / 2, len(arena.who)
    blue_to_goal, yellow_to_goal = hypot(half_length - ball.x, ball.y), hypot(half_length + ball.x, ball.y)
    blue_own, yellow_own = _own_rewards(arena)
    total, part = 0.0, 1.0 / max(learners, 1)
    for k in range(learners):
        is_blue, memory = arena.who[k] < blue, arena.memories[k]
        sign = 1.0 if is_blue else -1.0
        earned = team_reward(
            weights,
            sign * course.goal,
            sign * course.fault,
            course.passed and is_blue,
            course.holder >= 0 and (course.holder < blue) == is_blue,
            blue_to_goal if is_blue else yellow_to_goal,
            memory,
            arena.terms,
            part,
        )
        mean_own = blue_own if is_blue else yellow_own
        earned += (1.0 - weights.shared) * memory.own + weights.shared * mean_own
        shares[k] += earned
        total += earned
    return total / max(learners, 1)


@compiled_inline
def _own_rewards(arena: _Arena) -> tuple[float, float]:
    """Compute each learner's own terms for a tick; return their means for blue and for yellow."""
    judged, ball, robots = arena.judged, arena.ball, arena.robots
    blue, weights, part = judged.blue, judged.weights, 1.0 / max(len(arena.who), 1)
    blues = yellows = 0
    of_blue = of_yellow = 0.0
    for k in range(len(arena.who)):
        me, memory = arena.who[k], arena.memories[k]
        sign, fired = 1.0 if me < blue else -1.0, arena.kicked[me]
        gap = _nearest(robots, me) - 2.0 * ROBOT_RADIUS
        own = own_reward(weights, judged.field, sign, robots[me], ball, fired, gap, memory, arena.terms, part)
        if weights.sent > 0.0 and fired:
            first, last = (0, blue) if me < blue else (blue, len(robots))
            aimed = weights.sent * sent(ball, robots, first, last, judged.rules.pass_length)
            arena.terms.sent += part * aimed
            own += aimed
        memory.own = own
        if me < blue:
            of_blue += own
            blues += 1
        else:
            of_yellow += own
            yellows += 1
    return of_blue / max(blues, 1), of_yellow / max(yellows, 1)


@compiled_inline
def _nearest(robots: Records[Robot], me: int) -> float:
    """Return the distance to the centre of the nearest other robot [m]."""
    nearest = inf
    for r in range(len(robots)):
        if r != me:
            x, y = robots[r].x - robots[me].x, robots[r].y - robots[me].y
            nearest = min(nearest, x * x + y * y)
    return sqrt(nearest)
