"""robobt: behaviour trees for robot soccer, with skills written by hand or learned.

What a first session needs is found here::

    import robobt

    scenario = robobt.load_scenario("striker_vs_goalkeeper")
    run = robobt.run_trials(scenario.with_robot("blue 0", rater="open_angle"), trials=20)
    print(run.summary().goals["blue"].trials)

Skills are in :mod:`robobt.skills`, nodes in :mod:`robobt.tree`; everything else has its own folder, which
``robobt.NAME`` reaches, as in ``robobt.plays.import_file("my_plays.py")``.
``import robobt`` is cheap: each name is imported when it is first used. Their types are declared
in ``__init__.pyi``.
"""

from robobt.config.lazy import lazily

__version__ = "0.1.0"

_HOMES = {
    "BallState": "world",
    "Frame": "world",
    "Match": "worlds",
    "MatchResult": "match",
    "PLAYS": "plays",
    "RobobtError": "config.errors",
    "RobotCommand": "world",
    "RobotId": "world",
    "RobotState": "world",
    "Run": "match",
    "Scenario": "match",
    "ScenarioError": "match",
    "Selector": "tree",
    "Sequence": "tree",
    "Skill": "skills",
    "Status": "tree",
    "Summary": "match",
    "Team": "world",
    "World": "world",
    "compare": "worlds",
    "load_policy": "models.policy",
    "load_scenario": "match",
    "play": "plays",
    "play_match": "worlds",
    "run_trials": "worlds",
    "sim_world": "worlds",
    "skill": "skills",
    "train": "learning.trained",
    "world_from": "worlds",
}

_ROOMS = (
    "challenges",
    "engines",
    "identify",
    "league",
    "learning",
    "live",
    "match",
    "models",
    "motion",
    "plays",
    "shots",
    "sim",
    "skills",
    "testing",
    "tournament",
    "tree",
    "what_if",
    "world",
)
"""Folders that ``robobt.NAME`` reaches without an import of their own."""

__all__ = ["__version__", *_HOMES]

__getattr__, _names = lazily(__name__, _HOMES, _ROOMS)


def __dir__() -> list[str]:
    return sorted({*__all__, *_ROOMS, *(name for name in globals() if name.startswith("__"))})
