"""Go-To-Ball among robots in matches of one robot, its planner and a model on the same starts.

    python -m benchmarks among_robots_in_matches go_to_ball_among_robots_ppo --starts 200
    python -m benchmarks among_robots_in_matches go_to_ball_among_robots_ppo --address league://grsim

The starts are the task's, but for those with the ball in a defence area, where no field player may go, and
the others begin at rest. The worlds are those of ``transfer.py``; with an address it is that one alone, in
which a simulator has to run (docs/league.md). The robot is ticked by the leaf ``GoToBall`` within the task's
1.5 m/s and 1.395 rad/s, the others drive back and forth as in the task. Printed are the starts in which it
came within 0.2 m of the ball and touched nobody, and those in which it touched somebody, with Wilson's 95 %
intervals, and how much later the model is there where both arrive. A world of the league is judged by what
the vision's filter says: nobody touches a robot that is not seen.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from math import pi

import numpy as np

from benchmarks.go_to_ball_among_robots import shares
from benchmarks.transfer import SEED, WORLDS
from robobt.learning.envs import GoToBallAmongRobotsSettings, make_task
from robobt.learning.envs.go_to_ball.task import TOUCHING
from robobt.learning.opponents.patrols import PATROL_TRAITS, Patrols
from robobt.match import MatchLoop, Scenario, WorldFactory
from robobt.plays import PLAYS
from robobt.sim import COMMAND
from robobt.sim.records import size
from robobt.skills import GoToBall, Skill, skill
from robobt.statistics import mean_interval
from robobt.tree import Behaviour, Status
from robobt.world import DIVISION_B, FloatArray, RobotCommand, Team, distance, wrap_angle
from robobt.world.rules import in_defense_area
from robobt.worlds import SIM, world_from

TASK = GoToBallAmongRobotsSettings()
REACHED = TASK.contact.distance
KEPT = 0.3
"""Least distance of the ball from a defence area [m]."""
DRAWN = 4000
"""Starts, of which those are played that have such a ball."""


@skill
class Patrol(Skill):
    """Drive back and forth between two places, the second first; always RUNNING.

    Args:
        way: the two places and the top speed, by their names in
            :data:`robobt.learning.opponents.patrols.PATROL_TRAITS`.
    """

    way: tuple[float, ...] = (0.0, 0.0, 1.0, 0.0, 1.0)

    def on_start(self) -> None:
        """Set off for the second place."""
        self._patrols = Patrols(self.me.limits, self.frame.period, 1, 1)
        self._patrols.restart(np.array([0]), np.array([[self.way]]))

    def on_running(self) -> Status:
        """Drive."""
        me = self.me
        robots = np.array([[[me.x, me.y, me.heading, me.vx, me.vy, me.omega]]])
        commands = np.zeros((1, 1, size(COMMAND)))
        self._patrols.decide(robots, commands)
        self.store.command = RobotCommand(*commands[0, 0, :3].tolist())
        return self.run()


@PLAYS.register("drive_between")
def drive_between(
    *, from_x: float = 0.0, from_y: float = 0.0, to_x: float = 1.0, to_y: float = 0.0, speed: float = 1.0
) -> Behaviour:
    """Drive back and forth."""
    return Patrol(way=(from_x, from_y, to_x, to_y, speed))


@PLAYS.register("to_the_ball")
def to_the_ball(*, policy: str = "geometric") -> Behaviour:
    """Get to the ball and no further."""
    return GoToBall(policy=policy)


def main(words: list[str] | None = None) -> None:
    """Print a line for each world and player."""
    parser = argparse.ArgumentParser(description="the way among moving robots, in matches")
    parser.add_argument("model", help="name or file of a model for GoToBall")
    parser.add_argument("--starts", type=int, default=200, help="how many of them, 200 by default")
    parser.add_argument(
        "--only",
        action="append",
        choices=list(WORLDS),
        help="one of the worlds, may be given again; else all",
    )
    parser.add_argument("--address", default=SIM, help="a world elsewhere, as robobt match --world takes it")
    given = parser.parse_args(words)
    rows = list(starts())
    if not 1 <= given.starts <= len(rows):
        parser.error(f"--starts: 1 to {len(rows)}, not {given.starts}")
    if given.only and given.address != SIM:
        parser.error("--only: with --address there is one world")
    try:
        GoToBall(policy=given.model)
        factory = world_from(given.address)
    except ValueError as error:
        parser.error(str(error))
    worlds = {given.address: WORLDS["default"]}
    if given.address == SIM:
        worlds = {name: WORLDS[name] for name in given.only or WORLDS}
    for world, simulator in worlds.items():
        planner, model = (
            told(world, simulator, policy, rows[: given.starts], factory)
            for policy in ("geometric", given.model)
        )
        both = (planner[:, 0] > 0) & (model[:, 0] > 0)
        later = "-"
        if both.sum() > 1:
            gap = mean_interval(model[both, 2] - planner[both, 2])
            later = f"{gap.low:+.2f} to {gap.high:+.2f} s"
        print(f"{world}: {later} later where both reach it", flush=True)


def told(
    world: str, simulator: object, policy: str, rows: list[dict[str, float]], factory: WorldFactory
) -> FloatArray:
    """Play all starts and print the line of one player; return whether it reached, touched, and when."""
    found = np.array([played(scenario(simulator, policy, row), k, factory) for k, row in enumerate(rows)])
    reached, touched = found[:, 0] > 0, found[:, 1] > 0
    time = f"{found[reached, 2].mean():.2f} s" if reached.any() else "-"
    print(f"{world}, {policy}: of {len(rows)} {shares(reached, touched)}, {time}", flush=True)
    return found


def starts() -> Iterator[dict[str, float]]:
    """Draw the task's starts with the ball where a field player may go."""
    task = make_task(TASK, 1)
    for row in task.sample_starts(SEED, DRAWN):
        start = dict(zip(task.start_columns, row.tolist(), strict=True))
        if not any(
            in_defense_area(DIVISION_B, team, start["ball_x"], start["ball_y"], KEPT) for team in Team
        ):
            yield start


def scenario(simulator: object, policy: str, start: dict[str, float]) -> Scenario:
    """Return the match of one start; yellow's robots and ways are turned into their team's view."""
    yellow: list[object] = []
    for k in range(TASK.others.count):
        prefix = f"other_{k}_"
        other = {name.removeprefix(prefix): value for name, value in start.items() if prefix in name}
        way = {name: other[name] * (1.0 if name == "speed" else -1.0) for name in PATROL_TRAITS}
        turned = wrap_angle(other["heading"] + pi)
        pose = {"position": (-other["x"], -other["y"]), "heading": turned}
        yellow.append({"number": k, "play": "drive_between", "params": way, "start": pose})
    blue = {
        "number": 0,
        "play": "to_the_ball",
        "params": {"policy": policy},
        "limits": {"max_speed": TASK.action.max_speed, "max_turn": TASK.action.max_turn},
        "start": {"position": (start["x"], start["y"]), "heading": start["heading"]},
    }
    return Scenario.model_validate(
        {
            "name": "among robots",
            "simulator": {"preset": simulator} if isinstance(simulator, str) else simulator,
            "period": TASK.period,
            "robots": {"blue": [blue], "yellow": yellow},
            "ball": {"position": (start["ball_x"], start["ball_y"])},
            "ends": {"time_limit": TASK.time_limit * TASK.period},
        }
    )


def played(match: Scenario, seed: int, factory: WorldFactory) -> tuple[float, float, float]:
    """Return whether the ball was reached, whether a robot was touched first, and when it ended [s]."""
    with MatchLoop(match, seed, factory) as playing:
        while playing.tick():
            truth = playing.world.truth()
            for me in truth.own:
                if any(distance(me.position, other.position) < TOUCHING for other in truth.opponents):
                    return 0.0, 1.0, truth.time
                if distance(me.position, truth.ball.position) < REACHED:
                    return 1.0, 0.0, truth.time
        return 0.0, 0.0, match.ends.time_limit
