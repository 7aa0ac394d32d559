"""``python -m benchmarks``: one command for each benchmark, which is imported when it is asked for."""

from __future__ import annotations

import sys
from collections.abc import Callable
from importlib import import_module

import typer

from robobt.cli import add_commands, global_options, run
from robobt.cli.common import one_line_errors

COMMANDS = {
    "sim": "sim:sim",
    "arenas": "sim:arenas",
    "tree": "tree:tree",
    "policy": "policy:policy",
    "env": "env:env",
    "match": "match:match",
    "first_run": "first_run:first_run_command",
    "live": "live:live",
    "shots": "shots:shots",
    "sprt": "sprt:sprt",
    "engines": "engines:engines",
    "tournament": "tournament:tournament",
    "train": "train:train",
    "ppo": "ppo:ppo",
    "train_to": "train_to:train_to",
    "degradation": "degradation:command",
    "blind_fields": "blind_fields:blind_fields",
    "delay_in_play": "delay_in_play:delay_in_play",
    "blind_team": "blind_team:blind_team",
    "late_team": "late_team:late_team",
    "any_number": "any_number:any_number",
    "filter": "filter:filter_",
    "chips": "chips:chips",
    "clock": "clock:clock",
    "league": "league:league",
    "what_if": "what_if:what_if",
    "measurements": "measurements:measurements",
}
"""The benchmarks by name, each a function of a module here."""

SCRIPTS = {
    "baselines": "Train every task by PPO and TD3 of robobt and of Stable-Baselines3, and compare them.",
    "soccer_suite": "Judge policies and scripts on the tasks of several robots.",
    "score_on_goalkeepers": "Judge a model that scores against each kind of goalkeeper.",
    "go_to_ball_among_robots": "Judge a model that drives to the ball among other robots.",
    "among_robots_in_matches": "The same in matches, in worlds that it was not trained in.",
    "transfer": "Judge a model of Score, Duel or Goalkeeper in such worlds.",
    "vision_faults": "Errors of the vision filter where vision is at fault.",
    "vmas_football": "Speed beside VMAS' football.",
    "install_sizes": "How large the packages are that each extra needs.",
}
"""Those that read their options themselves: modules with a function ``main``."""


def application(only: str | None = None) -> typer.Typer:
    """Make the application; of one command alone where that is all that is asked for."""
    known = only in COMMANDS or only in SCRIPTS
    made = typer.Typer(
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        help="How fast robobt is, and what its models are worth.",
    )
    made.callback()(global_options)
    asked = {name: place for name, place in COMMANDS.items() if name == only or not known}
    add_commands(made, asked, "benchmarks")
    anything = {"ignore_unknown_options": True, "allow_extra_args": True}
    for name, about in SCRIPTS.items():
        if name == only or not known:
            made.command(name, help=about, add_help_option=False, context_settings=anything)(
                one_line_errors(_script(name))
            )
    return made


def _script(name: str) -> Callable[[typer.Context], None]:
    def run_script(context: typer.Context) -> None:
        sys.argv = [f"python -m benchmarks {name}", *context.args]
        import_module(f"benchmarks.{name}").main()

    return run_script


if __name__ == "__main__":
    run(application, "python -m benchmarks")
