"""2. Attack against a goalkeeper: many trials, counted honestly.

Plays the bundled scenario with each shot rater and prints goals with their
95 % Wilson intervals, and how many kicks that took: with 40 trials each, most differences are not yet
one. The paper's network (nn_filtered) scores least often because it hardly ever shoots: it waits for a
shot that is as good as sure, and time runs out. What it is good for is not to waste a shot, where one
is all there is; a predictor that waits for no more than a good chance is expected_goal.

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
        kicks = sum(result.robots["blue 0"].kicks for result in run.results)
        interval = f"{goals.low:.0%} to {goals.high:.0%}"
        print(f"  {rater:18} {goals.count:3d} scored   {interval:12}  {kicks:3d} kicks")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
