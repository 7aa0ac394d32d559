"""One training in a process of its own, until its policy is good enough, with the robobt of any checkout."""

from __future__ import annotations

import gc
import json
import sys
import tempfile
import time
from contextlib import suppress
from dataclasses import replace
from typing import Any


class GoodEnough(BaseException):
    """Ends a training in the middle of an evaluation."""


def main(asked: dict[str, Any]) -> dict[str, Any]:
    """Train as ``robobt train`` does, and look at the held-out starts at each evaluation.

    Args:
        asked: task, preset, bar (share of the held-out starts), starts (how many of them) and changes
            (settings by dotted name).

    Returns:
        cpu_s, of the whole process [s] without what the held-out starts took, steps, and reached, whether the
        bar was; success, of the last policy on the held-out starts; curve, the rows of steps, cpu_s and
        success.
    """
    # As the command line has it.
    gc.set_threshold(400_000, 10, 10)
    from robobt.learning.training.problems import problem_for
    from robobt.learning.training.settings import load_settings
    from robobt.learning.training.train import train

    settings = load_settings(asked["task"], asked["preset"], asked["changes"])
    problem = problem_for(settings)
    curve: list[tuple[int, float, float]] = []
    aside = 0.0

    def evaluate(policy: Any, split: Any, starts: int) -> Any:
        nonlocal aside
        found = problem.evaluate(policy, split, starts)
        if split == "validation":
            spent = time.process_time() - aside
            held_out = problem.evaluate(policy, "held_out", asked["starts"]).rate
            aside = time.process_time() - spent
            steps = min((len(curve) + 1) * settings.evaluation.every, settings.steps)
            curve.append((steps, round(spent, 2), held_out))
            if held_out >= asked["bar"]:
                raise GoodEnough
        return found

    with tempfile.TemporaryDirectory() as folder, suppress(GoodEnough):
        train(settings, folder, problem=replace(problem, evaluate=evaluate))
    steps, cpu_s, success = curve[-1]
    reached = success >= asked["bar"]
    return {"cpu_s": cpu_s, "steps": steps, "reached": reached, "success": success, "curve": curve}


if __name__ == "__main__":
    print(json.dumps(main(json.loads(sys.argv[1]))))
