"""1. Compose a play: a behaviour tree of skills, looked at, then played once.

python examples/01_compose_a_play.py
"""

import robobt
from robobt.skills import GoToBall, HasBall, KickToTarget, PickUpBall, SelectShot
from robobt.tree import Behaviour, Selector, Sequence, tree_text


@robobt.PLAYS.register("my_striker")
def my_striker() -> Behaviour:
    """With the ball: choose a shot and take it. Without: go and get it.

    ``memory=False`` asks every question anew at every tick, so a robot that
    loses the ball goes after it at once.
    """
    score = Sequence("score", memory=False, children=[HasBall(), SelectShot(), KickToTarget()])
    win = Sequence("win the ball", memory=False, children=[GoToBall(), PickUpBall()])
    return Selector("my striker", memory=False, children=[score, win])


SCENARIO = robobt.Scenario.model_validate(
    {
        "name": "first_play",
        "robots": {"blue": [{"number": 1, "play": "my_striker", "start": {"position": (-2.0, 0.5)}}]},
        "ball": {"position": (0.0, 0.0)},
        "ends": {"time_limit": 15.0},
    }
)


def main() -> None:
    print(tree_text(my_striker()))
    result = robobt.play_match(SCENARIO, seed=1, record="out/first_play.robobt.arrows")
    print(f"\n{result.outcome} after {result.time:.2f} s")
    print("robobt replay out/first_play.robobt.arrows --html out/first_play.html   makes a page of it")


if __name__ == "__main__":
    main()
