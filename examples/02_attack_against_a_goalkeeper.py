"""2. Attack against a goalkeeper: many trials, counted honestly.

Plays the bundled scenario with each shot rater and prints goals with their
95 % Wilson intervals: with 40 trials each, most differences are not yet one.

    python examples/02_attack_against_a_goalkeeper.py [trials]
"""

import sys

from robobt.match import load_scenario, run_trials, summarise
from robobt.skills.aim.raters import RATERS
from robobt.worlds import sim_world


def main(trials: int = 40) -> None:
    scenario = load_scenario("striker_vs_goalie")
    print(f"{scenario.name}, {trials} trials a rater, seed {scenario.seed}")
    for rater in RATERS:
        striker = scenario.robots.blue[0].model_copy(update={"params": {"rater": rater}})
        robots = scenario.robots.model_copy(update={"blue": (striker,)})
        changed = scenario.model_copy(update={"robots": robots})
        run = run_trials(changed, sim_world, trials)
        goals = summarise(run.results, changed.seed).goals["blue"].trials
        print(f"  {rater:18} {goals.count:3d} scored   {goals.low:.0%} to {goals.high:.0%}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
