"""How fast the environments are: control steps a second with observations, rewards and new starts."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from time import process_time
from typing import Annotated

import gymnasium
import numpy as np
import typer

import robobt.learning  # noqa: F401 - registers the environments
from robobt.cli import Json, console, print_json, table
from robobt.cli.common import errors
from robobt.learning import GoToBallTask, straight_drive
from robobt.learning.envs.score_on_goalkeeper.task import ScoreOnGoalkeeperTask
from robobt.learning.envs.scripted import crowd, drive_and_kick, turn_and_kick
from robobt.learning.envs.shoot.task import ShootTask
from robobt.learning.envs.soccer.suite import Small3v3Settings
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray
from robobt.sim import COMMAND
from robobt.sim.records import size

SIZES = {"single": 1, "vector_64": 64, "vector": 256}
"""Ends of the result's keys, and how many arenas they stand for."""

_CHUNK = 2000
"""Environment steps a chunk at least; long enough that reading the clock costs nothing."""

_FEWEST = 20

Task = GoToBallTask | ShootTask | ScoreOnGoalkeeperTask | SoccerTask
Decide = Callable[[FloatArray], FloatArray]


def bench_env(seconds: float = 2.0) -> dict[str, float]:
    """Measure the environments on one core, with 30 ms control and the default 4 physics steps.

    The robots drive to the ball, turn and kick, or do both, by hand-written policies, so
    that episodes start and end as in training; in Small3v3 all four learners crowd round it. Deciding is
    not in the time.

    Each figure takes ``seconds`` of CPU time, in chunks of which the fastest counts.

    Returns:
        environment steps a second of CPU time, a step of Score-On-Goalkeeper and Small3v3 being two
        control periods: ``go_to_ball_...``, ``shoot_...``, ``score_...`` and ``small3v3_...`` with each of
        :data:`SIZES`, of the tasks that learners step;
        ``..._gymnasium`` of one environment from ``gymnasium.make``. And
        ``..._physics_share``, the part of a vector step's time that the physics
        alone takes with the same commands.
    """
    figures: dict[str, float] = {}
    small = Small3v3Settings()
    cases: tuple[tuple[str, Callable[..., Task], Decide, str], ...] = (
        ("go_to_ball", GoToBallTask, straight_drive, "robobt/GoToBall-v0"),
        ("shoot", ShootTask, turn_and_kick, "robobt/ShootTowardsGoal-v0"),
        ("score", ScoreOnGoalkeeperTask, drive_and_kick, "robobt/ScoreOnGoalkeeper-v0"),
        (
            "small3v3",
            partial(SoccerTask, small),
            lambda seen: crowd(seen, len(small.learners)),
            "robobt/Small3v3-v0",
        ),
    )
    for name, kind, decide, env_id in cases:
        for arenas, n in SIZES.items():
            step, physics = _measure(kind(n=n, seed=0), decide, seconds)
            figures[f"{name}_{arenas}"] = n / step
        figures[f"{name}_physics_share"] = physics / step
        figures[f"{name}_gymnasium"] = 1.0 / _measure_gymnasium(env_id, decide, seconds)
    return figures


def _measure(task: Task, decide: Decide, seconds: float) -> tuple[float, float]:
    """Measure the CPU seconds of a step of all arenas, and of the physics alone."""
    observation = task.reset()
    best = bare = end = float("inf")
    chunk = max(_FEWEST, _CHUNK // task.n)
    warm = False
    while process_time() < end:
        spent = 0.0
        for _ in range(chunk):
            actions = decide(observation)
            begin = process_time()
            result = task.step(actions)
            spent += process_time() - begin
            observation = result.observation
        if warm:
            best = min(best, spent / chunk)
            bare = min(bare, _physics(task, chunk))
            observation = task.restart()
        else:
            # The first chunk compiles.
            warm, end = True, process_time() + seconds
    return best, bare


def _physics(task: Task, steps: int) -> float:
    commands = np.zeros((task.n, task.robots, size(COMMAND)))
    commands.view(COMMAND)["omega"] = 1.0
    begin = process_time()
    for _ in range(steps * task.settings.decide_every):
        task.arenas.step(commands)
    return (process_time() - begin) / steps


def _measure_gymnasium(env_id: str, decide: Decide, seconds: float) -> float:
    env = gymnasium.make(env_id)
    observation, _ = env.reset(seed=0)
    best = end = float("inf")
    warm = False
    while process_time() < end:
        spent = 0.0
        for _ in range(_CHUNK):
            action = decide(observation[None].astype(np.float64))[0].astype(np.float32)
            begin = process_time()
            observation, _, terminated, truncated, _ = env.step(action)
            if terminated or truncated:
                observation, _ = env.reset()
            spent += process_time() - begin
        if warm:
            best = min(best, spent / _CHUNK)
        else:
            warm, end = True, process_time() + seconds
    env.close()
    return best


def env(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each figure.")
    ] = 2.0,
    as_json: Json = False,
) -> None:
    """Measure the training environments: steps a second of CPU time, 30 ms control, 4 physics steps.

    Observations, rewards, walls, ball contacts and new starts are in the time.

    A step of Score-On-Goalkeeper and Small3v3 is a decision, of two periods; of Small3v3's arenas, of all
    learners together.

    Keys of --json, steps a second: go_to_ball_vector, shoot_vector, score_vector and
    small3v3_vector (256 arenas), ..._vector_64, ..._single (one arena) and ..._gymnasium (one
    environment of gymnasium.make); and ..._physics_share, the part of a vector
    step that the physics alone takes.
    """

    with errors.status("measuring the environments"):
        figures = bench_env(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    sizes = {**{end: f"{arenas} arenas" for end, arenas in SIZES.items()}, "gymnasium": "gymnasium.make"}
    listed = table("steps/s", *sizes.values(), "physics")
    for task in ("go_to_ball", "shoot", "score", "small3v3"):
        speeds = [f"{figures[f'{task}_{end}']:,.0f}" for end in sizes]
        listed.add_row(task.replace("_", " "), *speeds, f"{figures[f'{task}_physics_share']:.0%}")
    console.print(listed)
