"""5. Train a skill, export it, and put it into a tree by its file.

Trains Go-To-Ball with DDPG in the vectorised environment (about half a minute),
writes the model with its card, and lets it and its hand-written twin get the
same balls: one word in the play is all that differs.

    python examples/05_train_a_skill.py [environment steps]
"""

import shutil
import sys
from pathlib import Path

import robobt
from robobt.learning.training.export_run import export_run
from robobt.learning.training.settings import load_settings
from robobt.learning.training.train import train


def main(steps: int = 160_000) -> None:
    shutil.rmtree("runs/example", ignore_errors=True)
    settings = load_settings("go_to_ball", "fast", {"steps": steps, "evaluation.held_out": 200})
    result = train(settings, "runs/example")
    held_out = result.figures["held_out"]
    print(f"held out: {held_out['successes']} of {held_out['starts']} balls reached")
    (model,) = export_run(Path("runs/example"), "example", Path("out/models"))
    print(f"written: {model}")

    scenario = robobt.load_scenario("table4_trial1_own")
    for policy in ("geometric", str(model)):
        figures = robobt.run_trials(scenario.with_robot("blue 0", policy=policy), 5).summary()
        print(f"{policy}: {figures.goals['blue'].trials.count} goals of 5, {figures.time.mean:.2f} s a trial")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
