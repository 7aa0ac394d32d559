# %% [markdown]
# # Write and test a skill
#
# A skill is a leaf of the tree. Its parameters are the fields of its class; it names in `reads` and
# `writes` what it shares with the other skills of its robot, and decides in `on_running` what the robot is
# commanded at this tick. This one drives once around the ball, to tease who defends.

# %%
from math import atan2, cos, pi, sin

import robobt
from robobt import Sequence, Skill, Status, skill
from robobt.motion import drive
from robobt.skills import GoToBall, KickToTarget, PickUpBall, SelectShot
from robobt.testing import (
    Ticker,
    alone,
    blue,
    eventually,
    frame,
    make_store,
    never,
    robot,
    succeeds,
    touches_the_ball,
)
from robobt.tree import Behaviour


@skill
class CircleBall(Skill):
    """Drive around the ball, facing it. SUCCESS when the time is over, never FAILURE.

    Args:
        radius: of the circle [m].
        seconds: how long [s].
    """

    radius: float = 0.6
    seconds: float = 3.0

    def on_start(self) -> None:
        # The frame's time is the only clock a skill may read.
        self._start = self.frame.time

    def on_running(self) -> Status:
        if self.frame.time - self._start >= self.seconds:
            return self.succeed("been round")
        me, ball = self.me, self.ball
        ahead = atan2(me.y - ball.y, me.x - ball.x) + pi / 6
        target = (ball.x + self.radius * cos(ahead), ball.y + self.radius * sin(ahead))
        facing = atan2(ball.y - me.y, ball.x - me.x)
        self.store.command = drive(me, target, facing, me.limits, self.frame.period, final_speed=1.0)
        return self.run(f"towards ({target[0]:.2f}, {target[1]:.2f})")


# %% [markdown]
# ## Test one decision
#
# One frame made by hand, one tick: no simulator is needed to see what the skill decides. `pytest` runs such
# functions, and gives them the fixtures `make_store` and `tick_on` that do the same as the two functions
# used here.


# %%
def test_it_sets_off_to_the_right_and_faces_the_ball() -> None:
    seen = frame(robot(x=-0.6), ball=(0.0, 0.0))
    store = make_store(seen)
    assert Ticker()(CircleBall(), [seen], store) == [Status.RUNNING]
    assert store.command.vy < 0.0  # left is positive
    assert abs(store.command.omega) < 1.0


test_it_sets_off_to_the_right_and_faces_the_ball()

# %% [markdown]
# ## Test its behaviour
#
# In the simulator a test says what happens eventually, what holds always and what never does. The first
# robot is alone on the field here.


# %%
def test_it_drives_around_the_ball_and_leaves_it_alone() -> None:
    circle = CircleBall(seconds=5.0)
    trial = alone(circle, (-1.0, 0.0, 0.0), ball=(0.0, 0.0))
    trial.run(
        6.0,
        eventually("it is on the far side", lambda frame: frame.own[0].x > 0.3),
        eventually("it has been round", succeeds(circle)),
        never("it touches the ball", touches_the_ball(blue(0))),
    )


test_it_drives_around_the_ball_and_leaves_it_alone()

# %% [markdown]
# ## Play it
#
# A play makes it part of a tree. `memory=True` goes on where it was at the last tick, so the circle is
# driven once.


# %%
@robobt.play
def tease_and_shoot() -> Behaviour:
    """Once around the ball, then get it and shoot."""
    steps = [CircleBall(seconds=4.0), GoToBall(), PickUpBall(), SelectShot(), KickToTarget()]
    return Sequence("tease and shoot", memory=True, children=steps)


scenario = robobt.Scenario.model_validate(
    {
        "name": "own_skill",
        "robots": {"blue": [{"number": 1, "play": "tease_and_shoot", "start": {"position": (-1.0, 0.0)}}]},
        "ends": {"time_limit": 20.0},
    }
)
result = robobt.play_match(scenario, seed=1)
print(f"in a match: {result.outcome} after {result.time:.2f} s")

# %% [markdown]
# All of what a test can say is in [Test your own skill](../testing.md).
#
# A skill in a file of its own is known to every command by `--import my_skills.py`; more on [skills and
# plays of your own](../trees.md#skills-and-plays-of-your-own).
