"""How tasks of several robots go on and end, compiled over all arenas."""

from __future__ import annotations

from math import hypot, inf, isnan, nan, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.judging import begin_tick, end_tick, goal_of, is_over
from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.soccer.rewards import SoccerReward, SoccerTerms, own_reward, sent, team_reward
from robobt.learning.envs.soccer.settings import SoccerRules, SoccerSettings
from robobt.learning.envs.task import SUCCESS, TRUNCATED, BoolArray, FloatArray
from robobt.world.compiled import compilable, compiled_lean, numbers_dtype, record_dtype
from robobt.world.field import FieldGeometry
from robobt.world.rules import KEPT_GAP, in_area, is_out
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

LAST, TAKEN_X, TAKEN_Y, LEFT_X, LEFT_Y, BLUE_TICKS, YELLOW_TICKS, GOAL = range(8)
"""What is kept of an episode: who held the ball last, -1 for nobody; where it came into that mouth and where
it was last in it [m], TAKEN_X nan where that robot has let go of it; for how many ticks in a row each team
has held it; the goal, 1 blue's, -1 yellow's."""
MIND = 8

KEPT = ROBOT_RADIUS + BALL_RADIUS + KEPT_GAP
"""Whose centre is farther from the ball has let go of it [m]."""

OUT, CARRIED, IN_AREA, TWICE = range(1, 5)
"""What stops play: a ball out, carried too far, a learner in the others' area, a ball touched twice."""

_SCORE, _SAVE, _KEEP, _PASS, _HOLD = range(5)
_SETTINGS, _FIELD = numbers_dtype(SoccerSettings), numbers_dtype(FieldGeometry)
TERMS = record_dtype(SoccerTerms)
"""Names of the reward's terms."""
_WEIGHTS, _RULES = numbers_dtype(SoccerReward), numbers_dtype(SoccerRules)


@compiled_lean
def judge(
    settings_: FloatArray,
    field_: FloatArray,
    weights_: FloatArray,
    rules_: FloatArray,
    aim: int,
    who: NDArray[np.int64],
    blue: int,
    robots: FloatArray,
    balls: FloatArray,
    contact: BoolArray,
    kicked: BoolArray,
    touch: NDArray[np.int64],
    kept: BoolArray,
    fouls: FloatArray,
    stops: NDArray[np.int64],
    minds: FloatArray,
    before: FloatArray,
    owns: FloatArray,
    shares: FloatArray,
    progress: FloatArray,
    terms_: FloatArray,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    """Judge a tick of all arenas; return whether any episode has ended.

    Args:
        settings_: numbers of the task's settings.
        field_: of the field.
        weights_: of the reward.
        rules_: of the rules.
        aim: index in ``AIMS``.
        who: (L,) indices of the learners.
        blue: how many robots, the first, are blue.
        robots: (n, R, 6) states.
        balls: (n, 4) states.
        contact: (n, R) in whose mouth the ball lies.
        kicked: (n, R) who kicked.
        touch: (n,) who touched the ball last, -1 for nobody.
        kept: (n,) whether the ball rests where it is yellow's goalkeeper's.
        fouls: (n,) which team broke a rule of restarts, 1 blue, -1 yellow, 0 nobody; where the rules have
            restarts, any rule afterwards.
        stops: (n,) what stops play without ending the episode, of
            :data:`OUT` and so on, 0 for nothing; filled where the rules have restarts.
        minds: (n, MIND) what is kept of the episodes.
        before: (n, L, 3) what the rewards keep.
        owns: (L,) scratch.
        shares: (n, L) rewards of the learners, added to.
        progress: (n, ...) rows of ``PROGRESS``.
        terms_: (n, ...) rows of ``TERMS``, added to.
        rewards: (n,) added to.
        ends: (3, n) filled.
    """
    settings: SoccerSettings = settings_.view(_SETTINGS)[0]
    field: FieldGeometry = field_.view(_FIELD)[0]
    weights: SoccerReward = weights_.view(_WEIGHTS)[0]
    rules: SoccerRules = rules_.view(_RULES)[0]
    episodes, terms = progress.view(PROGRESS), terms_.view(TERMS)
    half_length, half_width, post = field.length / 2, field.width / 2, field.goal_width / 2
    any_ended, part = False, 1.0 / max(len(who), 1)
    for i in range(len(balls)):
        if is_over(ends, i):
            any_ended = True
            continue
        ball, mind = balls[i], minds[i]
        episode: Progress = episodes[i, 0]
        fired = False
        for index in who:
            fired = fired or kicked[i, index]
        begin_tick(episode, fired)
        side = goal_of(episode, ball, half_length, half_width, post)
        mind[GOAL] = side
        out = is_out(ball[0], ball[1], half_length, half_width) and side == 0
        holder, passed, too_far = _possession(rules, robots[i], contact[i], kicked[i], ball, blue, mind)
        # Who broke a rule: 1 blue, -1 yellow, 0 nobody.
        fault, stop = fouls[i], stops[i]
        if out:
            stop = OUT
            if touch[i] >= 0:
                fault = 1.0 if touch[i] < blue else -1.0
        lost = rules.longest_hold is not None and mind[BLUE_TICKS] > rules.longest_hold
        if too_far:
            fault, stop = 1.0 if holder < blue else -1.0, CARRIED
        if rules.areas:
            for index in who:
                sign = 1.0 if index < blue else -1.0
                x, y = sign * robots[i, index, 0], sign * robots[i, index, 1]
                if in_area(x, y, half_length, field.defense_depth, field.defense_width):
                    fault, stop = sign, IN_AREA
        lost = lost or (aim != _SAVE and (_at_least(mind[YELLOW_TICKS], rules.held_by) or kept[i]))
        if lost:
            fault = 1.0
        # Who ended it by that.
        ended = fault
        if rules.restarts:
            out, ended = False, 1.0 if lost else 0.0
            fouls[i], stops[i] = fault, 0 if lost or side != 0 else stop
        failed = out or ended != 0.0 or side < 0
        success = side > 0
        if aim == _SAVE:
            success = side > 0 or out or ended < 0.0 or _at_least(mind[BLUE_TICKS], rules.held_by)
            failed = side < 0 or ended > 0.0
        elif aim == _PASS:
            success = passed and not failed
            failed = failed or side > 0
        elif aim == _HOLD:
            success = mind[BLUE_TICKS] >= rules.hold and not failed
            failed = failed or side > 0
        elif aim == _KEEP:
            success = False
            failed = failed or side > 0
        success = success and not (failed and aim != _SCORE)
        ball_to_goal = hypot(half_length - ball[0], ball[1]), hypot(half_length + ball[0], ball[1])
        blues = yellows = 0
        of_blue = of_yellow = 0.0
        for k in range(len(who)):
            team = 0 if who[k] < blue else 1
            sign = 1.0 if team == 0 else -1.0
            robot = robots[i, who[k]]
            nearest = inf
            for r in range(robots.shape[1]):
                if r != who[k]:
                    x, y = robots[i, r, 0] - robot[0], robots[i, r, 1] - robot[1]
                    nearest = min(nearest, x * x + y * y)
            owns[k] = own_reward(
                weights,
                sign * half_length,
                post,
                robot,
                ball,
                kicked[i, who[k]],
                sqrt(nearest) - 2.0 * ROBOT_RADIUS,
                before[i, k],
                terms[i, 0],
                part,
            )
            if weights.sent > 0.0 and kicked[i, who[k]]:
                first, last = (0, blue) if team == 0 else (blue, robots.shape[1])
                aimed = weights.sent * sent(ball, robots[i], first, last, rules.pass_length)
                terms[i, 0].sent += part * aimed
                owns[k] += aimed
            if team == 0:
                of_blue += owns[k]
                blues += 1
            else:
                of_yellow += owns[k]
                yellows += 1
        total = 0.0
        for k in range(len(who)):
            team = 0 if who[k] < blue else 1
            sign = 1.0 if team == 0 else -1.0
            holds = holder >= 0 and (holder < blue) == (team == 0)
            earned = team_reward(
                weights,
                sign * side,
                sign * fault,
                passed and team == 0,
                holds,
                ball_to_goal[team],
                before[i, k],
                terms[i, 0],
                part,
            )
            mean_own = of_blue / blues if team == 0 else of_yellow / yellows
            earned += (1.0 - weights.shared) * owns[k] + weights.shared * mean_own
            shares[i, k] += earned
            total += earned
        mean = total / max(len(who), 1)
        if end_tick(episode, mean, success, failed, settings.time_limit, i, rewards, ends):
            any_ended = True
            # Who had nothing to do but to hold out has done it.
            if ends[TRUNCATED, i] and aim in (_SAVE, _KEEP):
                ends[SUCCESS, i] = True
    return any_ended


@compilable
def _at_least(ticks: float, most: int | None) -> bool:
    return most is not None and ticks >= most


@compiled_lean
def _possession(
    rules: SoccerRules,
    robots: FloatArray,
    contact: BoolArray,
    kicked: BoolArray,
    ball: FloatArray,
    blue: int,
    mind: FloatArray,
) -> tuple[int, bool, bool]:
    """Follow the ball; return who holds it, -1 for nobody, whether it was passed, and carried too far."""
    holder = -1
    for r in range(len(contact)):
        if contact[r]:
            holder = r
    mind[BLUE_TICKS] = mind[BLUE_TICKS] + 1.0 if 0 <= holder < blue else 0.0
    mind[YELLOW_TICKS] = mind[YELLOW_TICKS] + 1.0 if holder >= blue else 0.0
    if holder < 0:
        for r in range(len(kicked)):
            if kicked[r]:
                # It had the ball, if for less than a tick.
                mind[LAST], mind[LEFT_X], mind[LEFT_Y] = r, ball[0], ball[1]
                mind[TAKEN_X] = nan
        had = int(mind[LAST])
        if had >= 0 and hypot(ball[0] - robots[had, 0], ball[1] - robots[had, 1]) > KEPT:
            mind[TAKEN_X] = nan
        return holder, False, False
    last, passed = int(mind[LAST]), False
    if holder != last:
        way = hypot(ball[0] - mind[LEFT_X], ball[1] - mind[LEFT_Y])
        passed = 0 <= last < blue and holder < blue and way >= rules.pass_length
        mind[LAST] = holder
    if holder != last or isnan(mind[TAKEN_X]):
        mind[TAKEN_X], mind[TAKEN_Y] = ball[0], ball[1]
    mind[LEFT_X], mind[LEFT_Y] = ball[0], ball[1]
    carried = hypot(ball[0] - mind[TAKEN_X], ball[1] - mind[TAKEN_Y])
    return holder, passed, rules.dribbling is not None and carried > rules.dribbling
