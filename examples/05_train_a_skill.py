# %% [markdown]
# # Train a skill and drop it in
#
# Go-To-Ball is learned by DDPG in the vectorised environment, in about half a minute. All settings of a
# run, with their units, are in [Files](../reference/files.md), a page of the site that `make docs` builds;
# rewards of your own are [a wrapper away](../environments.md#a-reward-term-of-your-own).

# %%
import shutil

import robobt

STEPS = 160_000

shutil.rmtree("out/runs/example", ignore_errors=True)
result = robobt.train("go_to_ball", steps=STEPS, out="out/runs/example", changes={"evaluation.held_out": 200})
held_out = result.figures["held_out"]
print(f"held out: {held_out['successes']} of {held_out['starts']} balls reached")

# %% [markdown]
# The best policy of the run becomes a model: a TorchScript file with a card, which says what it observes
# and answers.

# %%
model = result.export("example", out="out/models")
print(f"written: {model}")

# %% [markdown]
# In the tree one word tells a learned skill from its hand-written twin. Both get the same balls:

# %%
scenario = robobt.load_scenario("table4_trial1_own")
for policy in ("geometric", str(model)):
    figures = robobt.run_trials(scenario.with_robot("blue 0", policy=policy), 5).summary()
    print(f"{policy}: {figures.goals['blue'].trials.count} goals of 5, {figures.time.mean:.2f} s a trial")

# %% [markdown]
# Go on with [training](../learning.md) and [learned skills](../learned_skills.md).
