"""6. Judge shots: collect some, learn which ones score, and shoot only then.

Collects shots in the simulator, fits a predictor with scikit-learn's contract,
counts how often it is right on shots it has not seen, and plays an attacker that
asks the shipped predictor beside one that does not.

    python examples/06_judge_shots.py [shots] [trials]
"""

import sys

import robobt
from robobt.shots.collect import CollectionSettings, collect_shots
from robobt.shots.data import goals, read_shots, shot_inputs
from robobt.shots.predict import best_predictor
from robobt.statistics import wilson_interval


def main(shots: int = 600, trials: int = 20) -> None:
    collect_shots(CollectionSettings(seed=1), "out/example_shots.parquet", shots)
    table = read_shots("out/example_shots.parquet")
    inputs, scored = shot_inputs(table), goals(table)
    train = len(scored) * 2 // 3
    predictor = best_predictor().fit(inputs[:train], scored[:train])
    right = int((predictor.predict(inputs[train:]) == scored[train:]).sum())
    low, high = wilson_interval(right, len(scored) - train)
    print(f"{len(scored)} shots, {scored.mean():.0%} scored")
    print(f"right about {right} of {len(scored) - train} unseen shots ({low:.0%} to {high:.0%})")

    scenario = robobt.load_scenario("deployed_half")
    for play in ("attack_main", "attack_nn", "attack_expected"):
        run = robobt.run_trials(scenario.with_robot("blue 0", play=play), trials)
        rate = run.summary().goals["blue"].trials
        print(f"  {play:15} {rate.count:3d} of {trials} scored   {rate.low:.0%} to {rate.high:.0%}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
