"""A policy in worlds that it was not trained in, beside the play it is to beat, from the same starts.

    python -m benchmarks transfer models/score.pt --trials 200
    python -m benchmarks transfer models/save.pt --only default --against attack_learned:policy=a.pt
    python -m benchmarks transfer models/score.pt --address league://grsim

The worlds are presets of the simulator, ``noisy`` the default one with ER-Force's realistic noise and delays.
With an address it is that world alone, in which a simulator has to run (docs/league.md). A model for Score or
Duel attacks beside ``attack_expected``, in the scenario ``score_on_goalkeeper``, ``score_on_defender``,
``score_on_two_defenders`` or ``duel``, as it has learned; one for Goalkeeper keeps goal against
``attack_expected`` beside ``team_goalkeeper``. Printed are trials with a goal, with Wilson's 95 % interval,
then what the model scores more or lets in more than the play in the same world, and than itself in the first,
in points, paired by trial.
"""

from __future__ import annotations

import argparse
from collections.abc import Mapping

from robobt.cli.option_groups.scenario import with_teams
from robobt.match import MatchResult, Scenario, load_scenario, run_trials_in
from robobt.match.results.compare import Difference, compare_results
from robobt.match.scenario.changes import changed
from robobt.models.find import read_fitting_model
from robobt.worlds import SIM, world_from

SEED = 3_000_017
"""Of the trials."""
DEFENDED = {"team_view_0_2": "score_on_defender", "team_view_0_3": "score_on_two_defenders"}
"""Scenarios for those that learned to score past defenders, by what they observe."""

WORLDS: Mapping[str, object] = {
    "default": "default",
    "noisy": {"preset": "default", "realism": "realistic"},
    "erforce": "erforce",
    "grsim": "grsim",
    "rsim": "rsim",
    "sumatra": "sumatra",
}
"""What a scenario holds under ``simulator``, by what it is called here."""


def main(words: list[str] | None = None) -> None:
    """Print a line for each world and player."""
    parser = argparse.ArgumentParser(description="a policy in other worlds")
    parser.add_argument("model", help="name or file of a model for Score, Duel or Goalkeeper")
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--against", default="", help="another opponent: PLAY[:NAME=VALUE,...]")
    parser.add_argument("--only", action="append", choices=list(WORLDS), help="all by default")
    parser.add_argument("--address", default=SIM, help="a world elsewhere, as robobt match --world takes it")
    given = parser.parse_args(words)
    base = load_scenario(scenario_of(given.model))
    players = variants(given.model, given.against)
    worlds: dict[str, Scenario] = {given.address: base}
    if given.address == SIM:
        worlds = {name: changed(base, {"simulator": WORLDS[name]}) for name in given.only or WORLDS}
    first: list[MatchResult] | None = None
    head = f"{'world':17}{'player':27}{'goals':>6} of {given.trials}   95 % interval"
    print(f"{head}    more than the play, than in the first world")
    for name, scenario in worlds.items():
        results = {
            label: list(
                run_trials_in(
                    with_teams(scenario, blue, yellow), world_from(given.address), given.trials, seed=SEED
                ).results
            )
            for label, (blue, yellow) in players.items()
        }
        model = list(players)[-1]
        first = first or results[model]
        found, moved = compare_results(results), compare_results({"first": first, "here": results[model]})
        for label, one in found.items():
            ahead, drop = one.against_first, moved["here"].against_first
            told = "" if ahead is None or drop is None else f"{_points(ahead.scored)}, {_points(drop.scored)}"
            print(f"{name:17}{label:27}{one.scored.count:6}   {one.scored.interval():18} {told}", flush=True)
            if one.errors:
                print(f"{'':17}trees failed in {one.errors} ticks; the first: {one.first_error}")


def variants(model: str, against: str = "") -> dict[str, tuple[str, str]]:
    """Return who plays for blue and for yellow, by what is judged: the written play, then the model.

    ``against`` is who opposes both; empty for who does in the scenario.

    Raises:
        ModelError: it is no model for Score, Duel or Goalkeeper.
    """
    skill = read_fitting_model(model, kind="policy").card.skill
    if skill == "Goalkeeper":
        keeper = f"team_goalkeeper:policy={model}"
        return {"team_goalkeeper": (against, "team_goalkeeper"), "Goalkeeper": (against, keeper)}
    if skill != "Duel":
        read_fitting_model(model, skill="Score")
    return {
        "attack_expected": ("attack_expected", against),
        str(skill): (f"attack_learned:policy={model}", against),
    }


def scenario_of(model: str) -> str:
    """Return the scenario in which the model meets what it learned against, with plays as opponents."""
    card = read_fitting_model(model, kind="policy").card
    if card.skill == "Duel":
        return "duel"
    seen = card.observation.name if card.skill == "Score" and card.observation else ""
    return DEFENDED.get(seen, "score_on_goalkeeper")


def _points(one: Difference) -> str:
    if one.mean is None or one.low is None or one.high is None:
        return "the same"
    return f"{100 * one.mean:+.1f} ({100 * one.low:+.1f} to {100 * one.high:+.1f})"
