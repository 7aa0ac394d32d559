"""``robobt bench sim``, ``arenas``, ``tree``, ``policy``, ``env``: parts of a match and of training."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

from robobt.cli.common import Json, console, errors, print_json, say, table


def bench_sim(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each case.")
    ] = 4.0,
    as_json: Json = False,
) -> None:
    """Measure the simulator: control steps a second with frames and commands, 25 ms control.

    Keys of --json: one_v_one, six_v_six and eleven_v_eleven, each with
    steps_per_s, bare_steps_per_s (the same space stepped by pymunk alone),
    bare_ratio (time of a step over that of a bare one) and contacts_per_s
    (how often the ball meets robots, a simulated second).
    """
    from robobt.sim.bench import bench_sim as measure

    with errors.status("measuring the simulator"):
        figures = measure(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    listed = table("case", "steps/s", "bare steps/s", "ratio to bare")
    for case, figure in figures.items():
        listed.add_row(
            case.replace("_", " "),
            f"{figure['steps_per_s']:,.0f}",
            f"{figure['bare_steps_per_s']:,.0f}",
            f"{figure['bare_ratio']:.2f}",
        )
    console.print(listed)


def bench_arenas(
    seconds: Annotated[
        float, typer.Option("--seconds", min=0.1, max=60, help="How long to measure each figure.")
    ] = 2.0,
    as_json: Json = False,
) -> None:
    """Measure crowded play in many arenas: control steps a second of CPU time, 4 physics steps in 30 ms.

    Keys of --json: by robots a team, by number of arenas, the steps a second of all arenas together.
    """
    from robobt.sim.bench import ARENAS
    from robobt.sim.bench import bench_arenas as measure

    with errors.status("measuring many arenas"):
        figures = measure(seconds=seconds)
    if as_json:
        print_json({str(side): speeds for side, speeds in figures.items()})
        return
    listed = table("a team", *(f"{n:,} arenas" for n in ARENAS))
    for side, speeds in figures.items():
        listed.add_row(str(side), *(f"{speeds[n]:,.0f}" for n in ARENAS))
    console.print(listed)


def bench_tree(as_json: Json = False) -> None:
    """Measure the trees: a tick of 30 nodes beside py_trees and beside plain classes.

    Keys of --json: speedup_vs_py_trees (against BehaviourTree.tick),
    ratio_to_plain_classes (time against a hand-written class tree with the same
    lifecycle), store_speedup_vs_blackboard (a read and a write of the store in
    every leaf, against the blackboard's), and the microseconds a tick that they
    come from. CPU time, medians.
    """
    from robobt.tree.bench import bench_tree as measure

    with errors.status("measuring trees"):
        figures = measure()
    _print(figures, as_json)


def bench_policy(
    model: Annotated[
        str, typer.Option("--model", help="Name or file of a TorchScript policy.")
    ] = "go_to_ball_ddpg",
    as_json: Json = False,
) -> None:
    """Measure one inference through the leaf beside the bare frozen module, batch 1, on one core.

    Keys of --json: leaf_to_module_ratio (a whole tick of LearnedSkill, from the
    frame to the command, over a call of the module on a tensor),
    skill_to_module_ratio (the same of the model's own skill) and the
    microseconds that they come from. CPU time, medians.
    """
    import torch

    from robobt.skills.bench import bench_policy as measure

    torch.set_num_threads(1)
    with errors.status("measuring policies"):
        figures = measure(model)
    _print(figures, as_json)


def bench_env(
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
    from robobt.learning.bench import SIZES
    from robobt.learning.bench import bench_env as measure

    with errors.status("measuring the environments"):
        figures = measure(seconds=seconds)
    if as_json:
        print_json(figures)
        return
    sizes = {**{end: f"{arenas} arenas" for end, arenas in SIZES.items()}, "gymnasium": "gymnasium.make"}
    listed = table("steps/s", *sizes.values(), "physics")
    for task in ("go_to_ball", "shoot", "score", "small3v3"):
        speeds = [f"{figures[f'{task}_{end}']:,.0f}" for end in sizes]
        listed.add_row(task.replace("_", " "), *speeds, f"{figures[f'{task}_physics_share']:.0%}")
    console.print(listed)


def _print(figures: Mapping[str, float], as_json: bool) -> None:
    if as_json:
        print_json(figures)
        return
    for name, figure in figures.items():
        say(f"{name.replace('_', ' '):32} {figure:8.2f}")
