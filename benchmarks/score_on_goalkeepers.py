"""A policy for Score against every kind of goalkeeper, on starts of its own; the script beside it.

    python -m benchmarks score_on_goalkeepers models/score_ppo.pt --starts 1000
    python -m benchmarks score_on_goalkeepers models/score_ppo.pt --set simulator=erforce --set decide_every=1

``shipped`` is the play ``goalkeeper``, at full speed as all are here but ``fitted``, which is as fast as
those of the paper's real shots. Neither is met in training by default. Goals with Wilson's 95 % interval,
and the mean time to a goal.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from typing import Any

import numpy as np

from robobt import load_policy
from robobt.cli.common import parse_assignments
from robobt.learning import run_starts
from robobt.learning.envs import ScoreOnGoalkeeperSettings, ScoreOnGoalkeeperTask
from robobt.learning.envs.evaluation import Decide
from robobt.learning.envs.scripted import drive_and_kick
from robobt.learning.opponents.keepers import GOALKEEPER_KINDS
from robobt.statistics import wilson_interval

SEED = 3_000_017
"""Of the starts: neither training's nor validation's nor the held-out ones."""


def main() -> None:
    """Print a line for each goalkeeper and policy."""
    parser = argparse.ArgumentParser(description="a policy against goalkeepers")
    parser.add_argument("model", help="name or file of a model for Score")
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--set", action="append", default=[], help="change the environment, NAME=VALUE")
    given = parser.parse_args()
    changes = parse_assignments(given.set, "--set")
    model = load_policy(given.model, skill="Score")
    policies: dict[str, Decide] = {"model": model, "script": drive_and_kick}
    print(f"{'goalkeeper':12}{'policy':10}{'goals':>6} of {given.starts}   95 % interval     time")
    for kind in GOALKEEPER_KINDS:
        for name, policy in policies.items():
            goals, time = score(policy, kind, given.starts, changes)
            low, high = wilson_interval(goals, given.starts)
            print(f"{kind:12}{name:10}{goals:6}   {low:15.1%} to {high:6.1%}   {time:5.2f} s", flush=True)


def score(policy: Decide, kind: str, count: int, changes: Mapping[str, Any]) -> tuple[int, float]:
    """Return goals from ``count`` starts and the mean time to one [s]."""
    plain = ScoreOnGoalkeeperSettings.model_validate(changes)
    top = plain.simulator.limits.max_speed
    keepers = {"keepers": {"kinds": [kind], "speed": [top, top]}}
    task = ScoreOnGoalkeeperTask(ScoreOnGoalkeeperSettings.model_validate({**changes, **keepers}), 64)
    episodes = run_starts(task, policy, task.sample_starts(SEED, count), SEED)
    scored = episodes.success
    return int(scored.sum()), float(episodes.time[scored].mean()) if scored.any() else float("nan")


if __name__ == "__main__":
    np.seterr(all="raise", under="ignore")
    main()
