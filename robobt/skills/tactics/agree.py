"""Assign tasks to the players, once per frame.

The first robot that asks updates the plan for all. Every choice depends on the last one, so that a robot
keeps its task until another is clearly better.
"""

from __future__ import annotations

from collections.abc import Iterator
from math import inf
from typing import TypeAlias

import numpy as np

from robobt.motion.meetings import meetings_of
from robobt.skills.aim.goalkeeper_watch import GoalkeeperWatch
from robobt.skills.kicker import follow_restart
from robobt.skills.plan import ASSIST, ATTACK, MARK, SUPPORT, Task, TeamPlan
from robobt.skills.store import Pass, TeamStore
from robobt.skills.tactics.assignment import NO_JOB, jobs_of
from robobt.skills.tactics.attacker import NOBODY, AttackerCandidate, choose_attacker, may_be_attacked
from robobt.skills.tactics.defence import mark_places, threats, wall_places
from robobt.skills.tactics.support import short_place, support_places
from robobt.world.game import BALL_PLACEMENT
from robobt.world.geometry import Point, distance
from robobt.world.records import MEETING, MOVER, movers_of
from robobt.world.rules import has_ball, owner
from robobt.world.state import Frame, RobotState

_RASTER = 0.05
_MOVER_NAMES = MOVER.names or ()
_QUICKNESS = slice(_MOVER_NAMES.index("max_speed"), _MOVER_NAMES.index("acceleration") + 1)
_TIME = (MEETING.names or ()).index("time")
_NO_CANDIDATE = AttackerCandidate(inf, 0.0, False)

_TASK_NUMBERS = {task._value_: -2 - place for place, task in enumerate(Task)}


def agree(frame: Frame, team: TeamStore) -> TeamPlan:
    """Bring the team's plan up to this frame, and return it."""
    plan = team.plan
    if plan.frame is frame:
        return plan
    plan.frame, plan.ways = frame, None
    follow_restart(frame, team)
    team.shared(GoalkeeperWatch).follow(frame)
    players = [robot for robot in frame.own if robot.id in plan.players]
    _look(frame, plan)
    _judge_possession(frame, team, plan)
    before = team.attacker
    team.attacker = _attacker(frame, team, plan)
    team.meeting = _meeting(frame, team, plan)
    if team.attacker != before:
        plan.attacker_since = frame.time
    if team.attacker != before or frame.time - plan.next_pass_time > plan.tactics.intent_lasts:
        plan.next_pass = None
    _share_out(frame, team, plan, players)
    return plan


def pass_under_way(frame: Frame, team: TeamStore) -> bool:
    """Return whether an own pass is still rolling towards its receiver."""
    if team.receiver is None or not 0.0 <= frame.time - team.pass_time <= team.plan.tactics.pass_lasts:
        return False
    if frame.time - team.pass_time < 0.2:
        return True
    return frame.ball.speed > 0.4 and owner(frame) is None


def _look(frame: Frame, plan: TeamPlan) -> None:
    plan.apply_tactics(frame.field, frame.ball_model)
    plan.rolling = plan.watch.rolling_speed(frame)
    everybody = movers_of(frame)
    plan.own_movers, theirs = everybody[: len(frame.own)], everybody[len(frame.own) :].copy()
    limited = theirs[:, _QUICKNESS]
    np.minimum(limited, plan.tactics.quickest, out=limited)
    plan.their_movers = theirs
    plan.meetings = meetings_of(frame, plan.rolling)
    times = plan.meetings[:, _TIME].tolist()
    ours, rest = times[: len(frame.own)], times[len(frame.own) :]
    plan.own_times = {robot.id: time for robot, time in zip(frame.own, ours, strict=True)}
    plan.their_times = {robot.id: time for robot, time in zip(frame.opponents, rest, strict=True)}


def _judge_possession(frame: Frame, team: TeamStore, plan: TeamPlan) -> None:
    holder = owner(frame)
    if holder is not None:
        ours = holder.team is frame.team
    elif pass_under_way(frame, team):
        ours = True
    else:
        margin = plan.tactics.ours_margin
        own = min((plan.own_times[n] for n in plan.players if n in plan.own_times), default=inf)
        ours = own < min(plan.their_times.values(), default=inf) + (margin if plan.ours else -margin)
    if not frame.game.in_play and frame.game.next_team is not None:
        ours = frame.game.next_team is frame.team
    if frame.game.restart is not None:
        ours = frame.game.restart_team is frame.team
    if ours == plan.ours:
        plan.ours_since = frame.time
    elif (
        frame.time - plan.ours_since >= plan.tactics.ours_after
        and frame.time - plan.turned >= plan.tactics.turns_after
    ):
        plan.ours, plan.ours_since, plan.turned = ours, frame.time, frame.time


def _attacker(frame: Frame, team: TeamStore, plan: TeamPlan) -> int | None:
    ball, game = frame.ball, frame.game
    if game.penalty is frame.team and game.may_touch and team.attacker in plan.own_times:
        return team.attacker
    placing = game.restart is BALL_PLACEMENT
    if not placing and not may_be_attacked(ball.x, ball.y, plan.numbers):
        return None
    shot = ball.vx > plan.tactics.shot_from and not pass_under_way(frame, team)
    if shot and game.in_play and team.attacker in plan.own_times and team.attacker != team.kicker:
        # Who gets the ball depends on what stops it.
        return team.attacker
    spot = game.placement if not game.in_play and game.placement is not None and not placing else None
    meant = team.receiver if pass_under_way(frame, team) else None
    candidates: list[float] = []
    players, kicker, times = plan.players, team.kicker, plan.own_times
    rows = {robot.id: row for row, robot in enumerate(frame.own)}
    for robot in frame.own:
        if robot.id not in players or robot.id == kicker:
            candidates += _NO_CANDIDATE
        elif spot is not None:
            # No robot has the ball yet or is beyond it.
            time = distance(spot, robot.position) / 2.0
            candidates += (time, ball.x, False)
        else:
            candidates += (times[robot.id], robot.x, has_ball(robot, ball))
    row = choose_attacker(
        np.array(candidates, dtype=np.float64).reshape(-1, len(AttackerCandidate._fields)),
        ball.x,
        ball.speed,
        NOBODY if meant is None else rows.get(meant, NOBODY),
        NOBODY if team.attacker is None else rows.get(team.attacker, NOBODY),
        frame.time - plan.attacker_since,
        game.restart is not None,
        plan.numbers,
    )
    return None if row == NOBODY else frame.own[row].id


def _meeting(frame: Frame, team: TeamStore, plan: TeamPlan) -> Point | None:
    """Return where the attacker meets the ball, rounded to a few centimetres so that it seldom changes."""
    if frame.ball.speed < plan.tactics.meeting_from or not frame.game.in_play:
        return None
    for row, robot in enumerate(frame.own):
        if robot.id == team.attacker:
            x, y = (_RASTER * round(v / _RASTER) for v in plan.meetings[row, 1:].tolist())
            return (x, y)
    return None


_PlacedTask: TypeAlias = tuple[Task, Point, int | None]
"""A task, its place, and the number of the opponent to mark."""


def _share_out(frame: Frame, team: TeamStore, plan: TeamPlan, players: list[RobotState]) -> None:
    """Give every player except the attacker a task and a place."""
    if abs(frame.ball.x) > plan.tactics.ahead_from:
        plan.ahead = frame.ball.x > 0.0
    team.threats = []
    tasks = {} if team.attacker is None else {team.attacker: ATTACK}
    if plan.at_ball and frame.game.in_play:
        may = [robot.id for robot in players if robot.id not in tasks and robot.id != team.kicker]
        tasks |= _assistants(plan, may, len(tasks))
    else:
        tasks |= _meant(frame, team, plan)
    free = [robot for robot in players if robot.id not in tasks]
    jobs = _jobs(frame, team, plan, len(players), len(free)) if free else []
    marks = {}
    for robot, (task, place, marked) in _hand_out(frame, plan, free, jobs):
        tasks[robot.id] = task
        plan.places[robot.id] = place
        if marked is not None:
            marks[robot.id] = marked
    plan.tasks = tasks
    plan.marks = team.marks = marks


def _assistants(plan: TeamPlan, free: list[int], attackers: int) -> dict[int, Task]:
    """Let those of the ``free`` robots assist that can have the ball first; assistants tend to stay."""
    gain = plan.tactics.switch_gain
    free.sort(key=lambda number: plan.own_times[number] - gain * (plan.tasks.get(number) is ASSIST))
    return dict.fromkeys(free[: plan.at_ball - attackers], ASSIST)


def _meant(frame: Frame, team: TeamStore, plan: TeamPlan) -> dict[int, Task]:
    """Send the intended receivers to where they will get their passes."""
    tasks: dict[int, Task] = {}
    intended = plan.next_pass
    if intended is not None:
        plan.meant[intended.receiver] = frame.time, intended.target
    for number, (time, target) in plan.meant.items():
        # A robot that was the receiver a moment ago stays, because it may be chosen again.
        if (
            number in plan.players
            and number != team.attacker
            and 0.0 <= frame.time - time < plan.tactics.meant_for
        ):
            tasks[number] = Task.RECEIVE
            plan.places[number] = target
    return tasks


def _jobs(frame: Frame, team: TeamStore, plan: TeamPlan, players: int, free: int) -> list[_PlacedTask]:
    """Return the tasks for ``free`` of the players, the most urgent first."""
    tactics = plan.tactics
    walls = 0 if plan.without == "wall" else wall_size(plan, players, free)
    wall = Task.WALL
    jobs: list[_PlacedTask] = [(wall, place, None) for place in wall_places(frame, walls, tactics)]
    plan.short = None if plan.without == "short_place" else short_place(frame, plan.short, tactics)
    if (
        plan.short is not None
        and free > len(jobs)
        and not _near(plan.next_pass, plan.short, tactics.same_place)
    ):
        jobs.append((SUPPORT, plan.short, None))
    left = free - len(jobs)
    if left and not plan.ours and plan.without != "marks":
        dangerous = threats(frame, tactics, set(plan.marks.values()))
        team.threats = [robot.id for robot in dangerous]
        marks = mark_places(frame, dangerous[: left - 1 if plan.ahead else left], tactics)
        jobs += [(MARK, place, number) for number, place in marks]
        left = free - len(jobs)
    if left:
        jobs += [(SUPPORT, place, None) for place in support_places(frame, team, plan, left)]
    return jobs


def _hand_out(
    frame: Frame, plan: TeamPlan, free: list[RobotState], jobs: list[_PlacedTask]
) -> Iterator[tuple[RobotState, _PlacedTask]]:
    """Yield the assignment of tasks with the least cost; a player's previous task is preferred."""
    if not jobs:
        return
    waiting = {robot.id for robot in free}
    rows = [row for row, robot in enumerate(frame.own) if robot.id in waiting]
    tasks, marks = plan.tasks, plan.marks
    found = jobs_of(
        plan.own_movers,
        np.array(rows),
        np.array([_kind(tasks.get(robot.id), marks.get(robot.id)) for robot in free]),
        np.array([number for _, place, _ in jobs for number in place]).reshape(-1, 2),
        np.array([_kind(task, marked) for task, _, marked in jobs]),
        plan.tactics.keep_gain,
        plan.tactics.long_way,
    )
    for robot, number in zip(free, found.tolist(), strict=True):
        if number != NO_JOB:
            yield robot, jobs[number]


def _kind(task: Task | None, marked: int | None) -> int:
    """Return the number of the opponent to mark, else a negative one of the task; None differs from all."""
    if marked is not None:
        return marked
    return -1 if task is None else _TASK_NUMBERS[task._value_]


def _near(intended: Pass | None, place: Point, gap: float) -> bool:
    return intended is not None and distance(intended.target, place) < gap


def wall_size(plan: TeamPlan, players: int, free: int) -> int:
    """Return how many robots cover the goal, from the number of players and of free players."""
    most = 1 if players <= 2 else 2 if players <= 6 else 3
    if plan.ours and plan.ahead:
        most -= 1
    return max(0, min(most, free))
