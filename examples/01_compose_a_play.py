# %% [markdown]
# # Compose a play
#
# A play is a function that returns a behaviour tree of skills. This one attacks: with the ball it chooses a
# shot and takes it, without it goes and gets the ball.

# %%
import robobt
from robobt.skills import GoToBall, HasBall, KickToTarget, PickUpBall, SelectShot
from robobt.tree import Behaviour, Selector, Sequence, tree_text


@robobt.play
def my_striker() -> Behaviour:
    """With the ball: choose a shot and take it. Without: go and get it."""
    score = Sequence("score", memory=False, children=[HasBall(), SelectShot(), KickToTarget()])
    win = Sequence("win the ball", memory=False, children=[GoToBall(), PickUpBall()])
    return Selector("my striker", memory=False, children=[score, win])


# %% [markdown]
# A *sequence* does its children one after the other until one fails, a *selector* takes the first that does
# not fail. `memory=False` asks every question anew at every tick: a robot that loses the ball goes after it
# at once.
#
# In a notebook a tree shows itself as a picture; as text it is this:

# %%
print(tree_text(my_striker()))
my_striker()

# %% [markdown]
# To play it, a scenario says who stands where, and when a trial ends. Positions are in metres from the
# middle of the field; blue attacks towards +x. There are [bundled scenarios](../scenarios.md) too: `robobt
# list scenarios`.

# %%
scenario = robobt.Scenario.model_validate(
    {
        "name": "first_play",
        "robots": {"blue": [{"number": 1, "play": "my_striker", "start": {"position": (-2.0, 0.5)}}]},
        "ball": {"position": (0.0, 0.0)},
        "ends": {"time_limit": 15.0},
    }
)
result = robobt.play_match(scenario, seed=1, record="out/first_play.robobt.arrows")
print(f"{result.outcome} after {result.time:.2f} s")
result

# %% [markdown]
# The recording holds what every node of the tree did at every tick. `robobt show
# out/first_play.robobt.arrows` makes it a page for the browser, with `--out out/first_play.gif --robot
# "blue 1"` an animation.
