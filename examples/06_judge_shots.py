# %% [markdown]
# # Judge shots
#
# Shots are collected in the simulator, a predictor learns which ones score, and is asked about shots that
# it has not seen.

# %%
import robobt
from robobt.shots import CollectionSettings, best_predictor, collect_shots, goals, read_shots, shot_inputs
from robobt.statistics import wilson_interval

SHOTS = 600

collect_shots(CollectionSettings(seed=1), "out/example_shots.parquet", SHOTS)
table = read_shots("out/example_shots.parquet")
inputs, scored = shot_inputs(table), goals(table)
train = len(scored) * 2 // 3
predictor = best_predictor().fit(inputs[:train], scored[:train])
right = int((predictor.predict(inputs[train:]) == scored[train:]).sum())
low, high = wilson_interval(right, len(scored) - train)
print(f"{len(scored)} shots, {scored.mean():.0%} scored")
print(f"right about {right} of {len(scored) - train} unseen shots ({low:.0%} to {high:.0%})")

# %% [markdown]
# Predictors follow scikit-learn's contract: constructor, `fit`, `predict`, `predict_proba`; one of your own
# is one more class with these.
#
# What that is good for: an attacker that asks the shipped predictor, `attack_expected`, beside one that
# does not and one with the paper's network.

# %%
TRIALS = 20

scenario = robobt.load_scenario("deployed_half")
for play in ("attack_main", "attack_nn", "attack_expected"):
    run = robobt.run_trials(scenario.with_robot("blue 0", play=play), TRIALS)
    rate = run.summary().goals["blue"].trials
    print(f"  {play:15} {rate.count:3d} of {TRIALS} scored   {rate.low:.0%} to {rate.high:.0%}")

# %% [markdown]
# [All about shots](../shots.md): other goalkeepers, the author's real ones, how the shipped models were
# made.
