# %% [markdown]
# # Attack against a goalkeeper
#
# Which way of choosing a shot scores most? Each *rater* plays the same trials, and goals are counted with
# their 95 % interval: with 40 trials each, most differences are not yet one.

# %%
import robobt
from robobt.skills import RATERS

TRIALS = 40

scenario = robobt.load_scenario("striker_vs_goalkeeper")
print(f"{scenario.name}, {TRIALS} trials a rater, seed {scenario.seed}")
for rater in RATERS:
    run = robobt.run_trials(scenario.with_robot("blue 0", rater=rater), TRIALS)
    goals = run.summary().goals["blue"].trials
    kicks = sum(result.robots["blue 0"].kicks for result in run.results)
    interval = f"{goals.low:.0%} to {goals.high:.0%}"
    print(f"  {rater:18} {goals.count:3d} scored   {interval:12}  {kicks:3d} kicks")

# %% [markdown]
# The paper's network (`nn_filtered`) scores least often because it hardly ever shoots: it waits for a shot
# that is as good as sure, and time runs out. What it is good for is not to waste a shot, where one is all
# there is; a predictor that waits for no more than a good chance is `expected_goal`. [Which statistic is
# for what](../statistics.md).
