"""robobt: behaviour trees for robot soccer, with skills written by hand or learned.

What a first session needs is found here::

    import robobt

    scenario = robobt.load_scenario("striker_vs_goalie")
    run = robobt.run_trials(scenario.with_robot("blue 0", rater="open_angle"), trials=20)
    print(run.summary().goals["blue"].trials)

Skills are in :mod:`robobt.skills`, nodes in :mod:`robobt.tree`; everything else has its own room.
``import robobt`` is cheap: each name is imported when it is first used. Their types are declared
in ``__init__.pyi``.
"""

from importlib import import_module

__version__ = "0.1.0"

_HOMES = {
    "BallState": "world",
    "Frame": "world",
    "Match": "worlds",
    "MatchResult": "match",
    "PLAYS": "plays",
    "RobobtError": "config.errors",
    "RobotCommand": "world",
    "RobotState": "world",
    "Run": "match",
    "Scenario": "match",
    "ScenarioError": "match",
    "Summary": "match",
    "World": "world",
    "load_policy": "models.policy",
    "load_scenario": "match",
    "play_match": "worlds",
    "run_trials": "worlds",
    "sim_world": "worlds",
    "world_from": "worlds",
}

__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*__all__, *(name for name in globals() if name.startswith("__"))})
