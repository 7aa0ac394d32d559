"""Three against three beside VMAS' scenario ``football``, on one thread, each at its best number of arenas.

    pip install vmas
    python -m benchmarks vmas_football

All six robots are learners that act at random: on either side observations and rewards of all of them are
in the time, and restarts of episodes. A step of VMAS is 0.1 s of circles in two sub-steps; one of ours a
decision of two control periods, 60 ms in eight physics steps, with hulls, dribblers, kicks and the league's
rules. The fastest of several chunks counts, taken in turn.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from time import process_time

import numpy as np
import torch

from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.task import SoccerTask

SIZES = (64, 256, 1024, 4096)
"""How many arenas are stepped together."""

_STEPS = 10
"""Steps of a chunk."""


def main() -> None:
    """Print steps and simulated seconds a second of CPU time for each size, and the ratio of the best."""
    parser = argparse.ArgumentParser(description="environment steps beside VMAS football")
    parser.add_argument("--chunks", type=int, default=5)
    given = parser.parse_args()
    torch.set_num_threads(1)
    best = {"robobt": 0.0, "vmas": 0.0}
    for n in SIZES:
        sides = {"robobt": ours(n), "vmas": theirs(n)}
        spent: dict[str, list[float]] = {name: [] for name in sides}
        for _ in range(given.chunks):
            for name, (step, _) in sides.items():
                spent[name].append(chunk(step))
        for name, (_, period) in sides.items():
            rate = n * _STEPS / min(spent[name])
            best[name] = max(best[name], rate)
            print(
                f"{n:5} arenas  {name:7}{rate:10,.0f} steps/s{rate * period:10,.0f} simulated s/s", flush=True
            )
    print(f"robobt, of VMAS' steps: {best['robobt'] / best['vmas']:.2f}")


def chunk(step: Callable[[], object]) -> float:
    """Return the CPU seconds of some steps, the first of which are not counted."""
    step()
    begin = process_time()
    for _ in range(_STEPS):
        step()
    return process_time() - begin


def ours(n: int) -> tuple[Callable[[], object], float]:
    """Return what steps ``n`` arenas of ours, and the length of a step [s]."""
    three = ("learner",) * 3
    settings = SoccerSettings(blue=three, yellow=three)
    task = SoccerTask(settings, n, seed=0)
    task.reset()
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (n, task.action_size))
    return lambda: task.step(actions), settings.decide_every * settings.period


def theirs(n: int) -> tuple[Callable[[], object], float]:
    """Return the figures of VMAS."""
    import vmas  # type: ignore[import-not-found]  # an optional dependency of this benchmark alone

    env = vmas.make_env(
        "football", num_envs=n, seed=0, n_blue_agents=3, n_red_agents=3, ai_red_agents=False, max_steps=167
    )
    actions = [env.get_random_action(agent) for agent in env.agents]

    def step() -> None:
        *_, dones, _ = env.step(actions)
        for index in torch.nonzero(dones).flatten().tolist():
            env.reset_at(index)

    return step, env.scenario.world.dt
