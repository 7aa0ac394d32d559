"""Go-To-Ball among robots: planner, freest way, straight drive, chance and models on the same fresh starts.

    python -m benchmarks go_to_ball_among_robots --starts 1000
    python -m benchmarks go_to_ball_among_robots models/among_robots.pt --set simulator=grsim

Reached and touched with Wilson's 95 % intervals, and the mean time to the ball. Models are compared with the
planner on the starts where both reach it. The planner is the skill ``GoToBall``, within the task's 1.5 m/s;
the freest way is a script of a few lines that sees what a policy sees.
"""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray

from robobt import load_policy
from robobt.cli.common import parse_assignments
from robobt.learning import run_starts
from robobt.learning.envs import GoToBallAmongRobotsSettings, make_task
from robobt.learning.envs.scripted import freest_way, straight_drive_among
from robobt.learning.envs.task_parts import Policy
from robobt.learning.training.teachers import playing, skill
from robobt.statistics import mean_interval, wilson_interval

SEED = 3_000_017
"""Of the starts: neither training's nor validation's nor the held-out ones."""


def main() -> None:
    """Print a line for each policy."""
    parser = argparse.ArgumentParser(description="policies among moving robots")
    parser.add_argument("models", nargs="*", help="names or files of models for GoToBall")
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--set", action="append", default=[], help="change the environment, NAME=VALUE")
    given = parser.parse_args()
    settings = GoToBallAmongRobotsSettings.model_validate(parse_assignments(given.set, "--set"))
    task = make_task(settings, min(64, given.starts))
    starts = task.sample_starts(SEED, given.starts)
    rng = np.random.default_rng(SEED)
    policies: dict[str, Policy] = {
        "planner": playing(task, skill(task)),
        "freest way": freest_way,
        "straight": straight_drive_among,
        "random": lambda seen: rng.uniform(-1.0, 1.0, (len(seen), task.action_size)),
        **{name: load_policy(name, skill="GoToBall") for name in given.models},
    }
    planner = None
    for name, policy in policies.items():
        episodes = run_starts(task, policy, starts, SEED)
        reached, touched = episodes.success, ~(episodes.success | episodes.truncated)
        time = f"{episodes.time[reached].mean():.2f} s" if reached.any() else "-"
        line = f"{name}: of {given.starts} {shares(reached, touched)}, {time}"
        if planner is not None and name in given.models:
            both = planner.success & reached
            later = mean_interval(episodes.time[both] - planner.time[both])
            line += f"; {later.low:+.2f} to {later.high:+.2f} s beside the planner where both reach it"
        planner = planner or episodes
        print(line, flush=True)


def shares(reached: NDArray[np.bool_], touched: NDArray[np.bool_]) -> str:
    """Return how many of the starts ended so, (n,) each, with intervals."""
    return " ".join(
        f"{label} {count.sum()} ({low:.1%} to {high:.1%})"
        for label, count in (("reached", reached), ("touched", touched))
        for low, high in (wilson_interval(int(count.sum()), len(count)),)
    )
