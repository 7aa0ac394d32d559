# %% [markdown]
# # Write and test a skill
#
# A skill is a leaf of the tree. Its parameters are the fields of its class; it names in `reads` and
# `writes` what it shares with the other skills of its robot, and decides in `on_running` what the robot is
# commanded at this tick. This one drives once around the ball, to tease who defends.

# %%
from math import atan2, cos, hypot, pi, sin

import robobt
from robobt import Skill, skill
from robobt.motion import drive
from robobt.skills import GoToBall, KickToTarget, PickUpBall, SelectShot, Store
from robobt.tree import Behaviour, Sequence, Status, TreeRunner
from robobt.world import DIVISION_B


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
# ## Test it alone
#
# One skill, one frame made by hand, one tick: no simulator is needed to see what it decides. `pytest` runs
# such functions.


# %%
def test_it_sets_off_to_the_right_and_faces_the_ball() -> None:
    me = robobt.RobotState(id=1, x=-0.6, y=0.0)
    frame = robobt.Frame(time=0.0, field=DIVISION_B, ball=robobt.BallState(0.0, 0.0), own=(me,))
    store = Store(frame, me)
    assert TreeRunner(CircleBall(), store).tick() is Status.RUNNING
    assert store.command.vy < 0.0  # left is positive
    assert abs(store.command.omega) < 1.0


test_it_sets_off_to_the_right_and_faces_the_ball()

# %% [markdown]
# ## Test it in the simulator
#
# A play makes it part of a tree. `memory=True` goes on where it was at the last tick, so the circle is
# driven once.


# %%
@robobt.PLAYS.register("tease_and_shoot")
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


def test_it_goes_round_the_ball_without_touching_it() -> None:
    quarters = set()
    with robobt.Match(scenario, seed=1) as match:
        while match.tick() and match.world.truth().time < 4.0:
            frame = match.world.truth()
            me, ball = frame.own[0], frame.ball
            assert hypot(me.x - ball.x, me.y - ball.y) > 0.2
            quarters.add((me.x > ball.x, me.y > ball.y))
    assert len(quarters) == 4


test_it_goes_round_the_ball_without_touching_it()
result = robobt.play_match(scenario, seed=1)
print(f"in a match: {result.outcome} after {result.time:.2f} s")

# %% [markdown]
# A skill in a file of its own is known to every command by `--import my_skills.py`; more on [skills and
# plays of your own](../trees.md#skills-and-plays-of-your-own).
