"""3. Write your own skill: a leaf of your own, first alone, then in a tree, then in a match.

A skill's parameters are the fields of its class. It names in ``reads`` and
``writes`` what it shares with the other skills of its robot, and decides in
``on_running`` what the robot is commanded at this tick.

    python examples/03_write_your_own_skill.py
"""

from math import atan2, cos, pi, sin

import robobt
from robobt.motion.pilot import drive
from robobt.skills import GoToBall, KickToTarget, PickUpBall, SelectShot
from robobt.skills.base import Skill, skill
from robobt.skills.store import Store
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


@robobt.PLAYS.register("tease_and_shoot")
def tease_and_shoot() -> Behaviour:
    """Once around the ball, then get it and shoot; ``memory=True`` goes on where it was."""
    steps = [CircleBall(seconds=4.0), GoToBall(), PickUpBall(), SelectShot(), KickToTarget()]
    return Sequence("tease and shoot", memory=True, children=steps)


def tick_it_alone() -> None:
    """One skill, one frame made by hand, one tick: how a skill is tested."""
    me = robobt.RobotState(id=1, x=-0.6, y=0.0)
    frame = robobt.Frame(time=0.0, field=DIVISION_B, ball=robobt.BallState(0.0, 0.0), own=(me,))
    store = Store(frame, me)
    runner = TreeRunner(CircleBall(), store)
    print(f"alone: {runner.tick().value}, {runner.root.feedback_message}")
    print(f"       command {store.command.vx:+.2f} m/s ahead, {store.command.vy:+.2f} m/s to the left")


def play_it() -> None:
    scenario = robobt.Scenario.model_validate(
        {
            "name": "own_skill",
            "robots": {
                "blue": [{"number": 1, "play": "tease_and_shoot", "start": {"position": (-1.0, 0.0)}}]
            },
            "ends": {"time_limit": 20.0},
        }
    )
    result = robobt.play_match(scenario, seed=1)
    print(f"in a match: {result.outcome} after {result.time:.2f} s")


if __name__ == "__main__":
    tick_it_alone()
    play_it()
