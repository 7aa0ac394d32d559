"""2. Attack against a goalkeeper: many trials, counted honestly.

Plays the bundled scenario with each shot rater and prints goals with their
95 % Wilson intervals: with 40 trials each, most differences are not yet one.

    python examples/02_attack_against_a_goalkeeper.py [trials]
"""

import sys

import robobt
from robobt.skills.aim.raters import RATERS


def main(trials: int = 40) -> None:
    scenario = robobt.load_scenario("striker_vs_goalie")
    print(f"{scenario.name}, {trials} trials a rater, seed {scenario.seed}")
    for rater in RATERS:
        run = robobt.run_trials(scenario.with_robot("blue 0", rater=rater), trials)
        goals = run.summary().goals["blue"].trials
        print(f"  {rater:18} {goals.count:3d} scored   {goals.low:.0%} to {goals.high:.0%}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
