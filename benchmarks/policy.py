"""How much a leaf adds to the network it runs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import numpy as np
import torch
import typer

from benchmarks.tree import medians, print_figures
from robobt.cli import Json, say
from robobt.cli.common import errors
from robobt.models import load_policy
from robobt.models.policy import bare_module
from robobt.skills import GoToBall, LearnedSkill, Shoot, Store
from robobt.tree import Behaviour, TreeRunner
from robobt.world import DIVISION_B, BallState, Frame, RobotCommand, RobotState

PERIOD = 0.03
"""Shortest time between two ticks [s]; policies that decide less often are ticked as often as they decide."""


def bench_policy(
    model: str | Path = "go_to_ball_ddpg", rounds: int = 25, calls: int = 400, robots: int = 1
) -> dict[str, float]:
    """Measure one inference through a leaf beside the same frozen module called on a tensor, batch 1.

    Through the leaf is a whole tick: the observation from the frame, the network,
    the check of its answer, the command, and the runner of the tree around it. The
    cases take turns, so that whatever else the machine does meets them all; each
    figure is the median of its CPU times.

    Args:
        model: name or file of a TorchScript policy.
        rounds: how often the cases take turns.
        calls: of a case in a round.
        robots: number of robots a side; with 1 there are no opponents.

    Returns:
        ``leaf_to_module_ratio``, a tick of :class:`LearnedSkill` over a call of the bare
        frozen module; ``skill_to_module_ratio``, that ratio for the model's own skill (GoToBall or Shoot),
        where it has one; ``team_ms``, the time in which all ``robots`` of a team decide [ms], with several;
        and the microseconds that they come from, under names in ``_us``.

    Raises:
        ModelError: the model cannot be used, or is not a TorchScript file.
    """
    policy = load_policy(model)
    step = max(PERIOD, policy.card.period or 0.0)
    ticks = (rounds + 1) * calls
    cases: dict[str, Callable[[], object]] = {
        "module_us": bare_module(policy),
        "leaf_us": _ticking(LearnedSkill(model=str(model)), ticks, robots, step),
    }
    own: dict[str, Callable[..., Behaviour]] = {"GoToBall": GoToBall, "Shoot": Shoot}
    if policy.card.skill in own:
        cases["skill_us"] = _ticking(own[policy.card.skill](policy=str(model)), ticks, robots, step)
    us = medians(cases, rounds, calls)
    figures = {"leaf_to_module_ratio": us["leaf_us"] / us["module_us"]}
    if robots > 1:
        figures["team_ms"] = robots * us["leaf_us"] / 1000.0
    if "skill_us" in us:
        figures["skill_to_module_ratio"] = us["skill_us"] / us["module_us"]
    return {**figures, **us}


def _ticking(leaf: Behaviour, ticks: int, robots: int, step: float) -> Callable[[], object]:
    """Return a tick of a leaf whose robot has the ball to get, or in its mouth: at most ``ticks`` calls.

    Each is a frame of its own, ``step`` [s] later: at the same instant a leaf would keep its last command
    instead of asking its network.
    """
    far = not isinstance(leaf, Shoot)
    me = RobotState(0, -1.0, 0.5, 0.4, 0.3, -0.2, 0.1, ball_contact=not far)
    ball = BallState(1.0, -0.5) if far else BallState(-1.0 + 0.1 * np.cos(0.4), 0.5 + 0.1 * np.sin(0.4))
    mates = [RobotState(k, -2.0, 0.4 * k - 2.0, 0.1 * k, 0.1, 0.0, 0.0) for k in range(1, robots)]
    others = [RobotState(k, 2.0, 0.4 * k - 2.0, 3.0, -0.1, 0.0, 0.0) for k in range(robots * (robots > 1))]
    team, opponents = (me, *mates), tuple(others)
    frames = iter([Frame(step * n, DIVISION_B, ball, team, opponents, period=PERIOD) for n in range(ticks)])
    store = Store(Frame(0.0, DIVISION_B, ball, (me,), period=PERIOD), me)
    runner = TreeRunner(leaf, store, on_error="raise")
    tick = runner.tick

    def once() -> None:
        store.frame = next(frames)
        store.command = RobotCommand()
        tick()

    return once


def policy(
    model: Annotated[
        str, typer.Option("--model", help="Name or file of a TorchScript policy.")
    ] = "go_to_ball_ddpg",
    robots: Annotated[
        int, typer.Option("--robots", min=1, max=11, help="Robots a side; 1 for one alone.")
    ] = 1,
    as_json: Json = False,
) -> None:
    """Measure one inference through the leaf beside the bare frozen module, batch 1, on one core.

    Keys of --json: leaf_to_module_ratio (a whole tick of LearnedSkill, from the
    frame to the command, over a call of the module on a tensor),
    skill_to_module_ratio (that ratio for the model's own skill), team_ms (with several robots: the time in
    which a team of them decides) and the microseconds that they come from. CPU time, medians; the cases take
    turns, after a round that does not count.
    """

    torch.set_num_threads(1)
    with errors.status("measuring policies"):
        figures = bench_policy(model, robots=robots)
    print_figures(figures, as_json)
    if not as_json:
        say(
            "Compared: CPU time of a tick, in which the leaf asks its network, beside a call of the network "
            "alone, in turn; medians, after a warm-up of one round."
        )
