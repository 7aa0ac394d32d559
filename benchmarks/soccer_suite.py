"""What a script and chance reach in the tasks of several robots, on fresh starts.

    python benchmarks/soccer_suite.py --starts 1000
    python benchmarks/soccer_suite.py --task Save --set simulator=grsim

Successes with Wilson's 95 % intervals and the mean length of an episode. The script plays in the learners'
places, as robobt.learning.envs.soccer.suite says; chance draws uniformly, and kicks once in twenty decisions.
"""

from __future__ import annotations

import argparse

import numpy as np

from robobt.cli.common import parse_assignments
from robobt.learning.envs import run_starts
from robobt.learning.envs.soccer.suite import SUITE, scripted
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray
from robobt.statistics import wilson_interval

SEED = 3_000_017
"""Of the starts: neither training's nor validation's nor the held-out ones."""
KICKS = 0.05


def main() -> None:
    """Print a line for each task and policy."""
    parser = argparse.ArgumentParser(description="script and chance in the tasks of several robots")
    parser.add_argument("--task", action="append", choices=list(SUITE), help="all by default")
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--set", action="append", default=[], help="change the environment, NAME=VALUE")
    given = parser.parse_args()
    changes = parse_assignments(given.set, "--set")
    for name in given.task or SUITE:
        settings = SUITE[name].model_validate(changes)
        for label, played in (("script", scripted(settings)), ("chance", settings)):
            task = SoccerTask(played, min(128, given.starts))
            chance = _Chance(task)
            episodes = run_starts(task, chance, task.sample_starts(SEED, given.starts), SEED)
            reached = int(episodes.success.sum())
            low, high = wilson_interval(reached, given.starts)
            length = episodes.time.mean()
            print(f"{name:33}{label:8}{reached:5} ({low:.1%} to {high:.1%}) {length:6.2f} s", flush=True)


class _Chance:
    """Draws every learner's actions; where a script plays there is nobody to draw for."""

    def __init__(self, task: SoccerTask) -> None:
        self._rng = np.random.default_rng(SEED)
        self._shape = len(task.learners), task.action.size

    def __call__(self, seen: FloatArray) -> FloatArray:
        actions = self._rng.uniform(-1.0, 1.0, (len(seen), *self._shape))
        actions[..., -1] += 2.0 * KICKS - 1.0
        return actions.reshape(len(seen), -1)


if __name__ == "__main__":
    main()
