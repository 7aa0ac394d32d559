"""Evaluations of a training run in the live page."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace
from queue import Empty

import numpy as np

from robobt.learning.envs import ArenaTask, make_task
from robobt.learning.training.problems import Problem, Split, problem_for, split_seed
from robobt.learning.training.results import Evaluation, Policy
from robobt.learning.training.settings import TrainSettings
from robobt.live.controls import IDLE_POLL, Controls
from robobt.live.server import Server
from robobt.live.stream import Stream
from robobt.match.recording import RecordedRobot, RecordingHeader
from robobt.match.recording.capture import Capture
from robobt.signals import check
from robobt.world.game import Team
from robobt.world.state import BallState, Frame, RobotState

SHOWN_STARTS = 5
"""Number of starts shown of each evaluation."""


def watched_problem(server: Server, settings: TrainSettings) -> Problem:
    """Return the problem of a run that shows its evaluations to a server's viewers in real time.

    Training waits while evaluations are watched; its result is the same.
    """
    problem = problem_for(settings)
    shows = _Shows(server, settings)

    def evaluate(policy: Policy, split: Split, starts: int) -> Evaluation:
        found = problem.evaluate(policy, split, starts)
        if server.viewers:
            shows.play(policy, split, f"{found.success.mean():.0%} of {starts} {split} starts")
        return found

    return replace(problem, evaluate=evaluate)


class _Shows:
    def __init__(self, server: Server, settings: TrainSettings) -> None:
        self._server, self._settings = server, settings
        self._controls = Controls(server)
        server.tell(movable=False, orders=False, plays=[], over=None, span=None)
        self._controls.tell()

    def play(self, policy: Policy, split: Split, figures: str) -> None:
        """Play a policy from some starts, at the viewers' speed."""
        task = make_task(self._settings.environment, 1)
        capture = Capture(_header_of(task, f"{self._settings.task}: {figures}"))
        self._server.show(Stream(capture))
        period = task.settings.period * task.settings.decide_every
        seed, left, ticks, due = split_seed(split), SHOWN_STARTS, 0, time.perf_counter()
        decide, observation = (
            task.jointly(policy),
            task.reset_to(task.sample_starts(seed, SHOWN_STARTS), seed),
        )
        while left > 0 and self._server.viewers:
            check()
            capture.tick(_frame_of(task, ticks * period, period))
            observation = task.step(decide(observation)).observation
            ticks += 1
            if task.ended is not None and (task.ended.start >= 0).any():
                left -= 1
                kind = "success" if bool(task.ended.success[0]) else "failure"
                capture.event(kind, ticks * period, text=f"after {float(task.ended.time[0]):.2f} s")
            due = max(due + period / self._controls.speed, time.perf_counter() - period)
            self._obey()
            time.sleep(max(0.0, due - time.perf_counter()))

    def _obey(self) -> None:
        while not self._server.inbox.empty():
            self._controls.take(self._server.inbox.get_nowait()[0])
        while self._controls.wait and self._server.viewers:
            check()
            with suppress(Empty):
                self._controls.take(self._server.inbox.get(timeout=IDLE_POLL)[0])
        self._controls.ticked()


def _header_of(task: ArenaTask, name: str) -> RecordingHeader:
    robots = tuple(
        RecordedRobot(team=Team.BLUE, number=index)
        if index < task.blue
        else RecordedRobot(team=Team.YELLOW, number=index - task.blue)
        for index in range(task.robots)
    )
    period = task.settings.period * task.settings.decide_every
    return RecordingHeader(scenario=name, period=period, field=task.settings.field, robots=robots)


def _frame_of(task: ArenaTask, time: float, period: float) -> Frame:
    arenas = task.arenas
    robots = []
    for index, (x, y, heading, vx, vy, omega) in enumerate(arenas.robots[0].tolist()):
        number = index if index < task.blue else index - task.blue
        held = bool(arenas.contact[0, index])
        robots.append(RobotState(number, x, y, heading, vx, vy, omega, held))
    ball = BallState(*np.asarray(arenas.balls[0]).tolist())
    own, opponents = tuple(robots[: task.blue]), tuple(robots[task.blue :])
    return Frame(time, task.settings.field, ball, own, opponents, period=period)
