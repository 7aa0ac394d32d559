"""What a script and chance reach in the tasks of several robots, on fresh starts; or plays and models.

    python -m benchmarks soccer_suite --starts 1000
    python -m benchmarks soccer_suite --task Save --set simulator=grsim
    python -m benchmarks soccer_suite --task ScoreOnGoalkeeperAndDefenders --play attack_expected --model a.pt

Successes with Wilson's 95 % intervals and the mean length of an episode. The script plays in the learners'
places, as robobt.learning.envs.soccer.suite says; chance draws uniformly, and kicks once in twenty decisions.
Plays and models play in blue's, against attackers where yellow learns too, and are compared with the first of
them from the same starts: difference in points, and McNemar's exact test.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator

import numpy as np

from robobt import load_policy
from robobt.cli.common import parse_assignments
from robobt.cli.option_groups.scenario import parse_play
from robobt.learning import run_starts
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import SUITE, against, instead, scripted
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.play_settings import PlaySettings
from robobt.statistics import mcnemar, paired_difference_interval, wilson_interval

SEED = 3_000_017
"""Of the starts: neither training's nor validation's nor the held-out ones."""
KICKS = 0.05


def main() -> None:
    """Print a line for each task and policy."""
    parser = argparse.ArgumentParser(description="who reaches what in the tasks of several robots")
    parser.add_argument("--task", action="append", choices=list(SUITE), help="all by default")
    parser.add_argument("--starts", type=int, default=1000)
    parser.add_argument("--set", action="append", default=[], help="change the environment, NAME=VALUE")
    parser.add_argument("--play", action="append", default=[], help="a play in the places of blue's learners")
    parser.add_argument("--model", action="append", default=[], help="a model there")
    given = parser.parse_args()
    changes = parse_assignments(given.set, "--set")
    for name in given.task or SUITE:
        settings, first = SUITE[name].model_validate(changes), None
        for label, episodes in _all(settings, given.play, given.model, given.starts):
            reached = int(episodes.success.sum())
            low, high = wilson_interval(reached, given.starts)
            told = f"{name:33}{label:8}{reached:5} ({low:.1%} to {high:.1%}) {episodes.time.mean():6.2f} s"
            # Episodes come as they end.
            success = episodes.success[np.argsort(episodes.start)]
            if first is not None:
                gap = paired_difference_interval(success, first)
                p = mcnemar(success, first).p
                told += f", {100 * gap.low:+.1f} to {100 * gap.high:+.1f} points, p = {p:.2g}"
            elif given.play or given.model:
                first = success
            print(told, flush=True)


def _all(
    settings: SoccerSettings, plays: list[str], models: list[str], starts: int
) -> Iterator[tuple[str, Episodes]]:
    if not plays and not models:
        yield "script", _run(scripted(settings), starts)
        yield "chance", _run(settings, starts)
    alone = against(settings, "attack")
    for play in plays:
        name, params = parse_play(play, "--play")
        yield play, _run(instead(alone, PlaySettings(play=name, params=params)), starts)
    for model in models:
        yield model, _run(alone, starts, load_policy(model, kind="policy"))


def _run(
    settings: SoccerSettings, starts: int, policy: Callable[[FloatArray], FloatArray] | None = None
) -> Episodes:
    task = SoccerTask(settings, min(128, starts))
    decide = _Chance(task) if policy is None else task.jointly(policy)
    return run_starts(task, decide, task.sample_starts(SEED, starts), SEED)


class _Chance:
    """Draws every learner's actions; with a script there are no learners."""

    def __init__(self, task: SoccerTask) -> None:
        self._rng = np.random.default_rng(SEED)
        self._shape = len(task.learners), task.action.size

    def __call__(self, seen: FloatArray) -> FloatArray:
        actions = self._rng.uniform(-1.0, 1.0, (len(seen), *self._shape))
        actions[..., -1] += 2.0 * KICKS - 1.0
        return actions.reshape(len(seen), -1)
