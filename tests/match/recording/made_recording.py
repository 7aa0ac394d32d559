"""A recording of a few robots made without a simulator, for tests of recordings and their pages."""

from __future__ import annotations

from math import cos, sin
from pathlib import Path

from robobt.match.recording import RecordedRobot, Recorder, RecordingHeader
from robobt.tree import Behaviour, Leaf, Selector, Sequence, Status, TreeRunner
from robobt.world import (
    DIVISION_B,
    BallState,
    Frame,
    GameState,
    RefereeCommand,
    RobotCommand,
    RobotId,
    RobotState,
    Team,
)

PERIOD = 1 / 60
BLUE_1 = RobotId(Team.BLUE, 1)
BLUE_4 = RobotId(Team.BLUE, 4)
YELLOW_0 = RobotId(Team.YELLOW, 0)


class Every(Leaf[None]):
    """Succeeds every so many ticks and fails in between, counting aloud."""

    def __init__(self, count: int, name: str = "") -> None:
        super().__init__(name)
        self.count, self.ticks = count, 0

    def on_running(self) -> Status:
        self.ticks += 1
        if self.ticks % self.count == 0:
            return self.succeed()
        return self.fail(f"{self.ticks % self.count} of {self.count}")


class Wait(Leaf[None]):
    def on_running(self) -> Status:
        return self.run("waits")


class Raises(Leaf[None]):
    def __init__(self, name: str, after: int = 0) -> None:
        super().__init__(name)
        self.left = after

    def on_running(self) -> Status:
        if self.left:
            self.left -= 1
            return Status.RUNNING
        raise RuntimeError("broken on purpose")


def tree(count: int = 7) -> Behaviour:
    return Selector(
        "play", memory=False, children=[Sequence("now and then", False, [Every(count), Wait()]), Wait("idle")]
    )


def header(field: object = DIVISION_B, **more: object) -> RecordingHeader:
    robots = (
        RecordedRobot(team=Team.BLUE, number=1, play="striker"),
        RecordedRobot(team=Team.BLUE, number=4),
        RecordedRobot(team=Team.YELLOW, number=0, play="goalkeeper", radius=0.085, mouth=0.07),
    )
    values = {"scenario": "made", "trial": 2, "seed": 5, "period": PERIOD, "field": field, "robots": robots}
    return RecordingHeader.model_validate(values | more)


def frame(tick: int, score: int = 0) -> Frame:
    """Three robots on circles and a ball on a line, from blue's side."""
    turn = 0.03 * tick
    return Frame(
        tick * PERIOD,
        DIVISION_B,
        BallState(-2.0 + 0.0123456 * tick, 0.5, 0.74, -0.01234),
        (
            RobotState(1, cos(turn), sin(turn), (turn + 1.6) % 3.0, 0.1, 0.2, 0.3, tick % 10 == 0),
            RobotState(4, -1.0 - cos(turn), sin(turn), -1.0, -0.1, 1.23456, -2.0),
        ),
        (RobotState(0, 4.4, 0.3 * sin(turn), 3.1, 0.0, 0.01, 0.0),),
        period=PERIOD,
        game=GameState(RefereeCommand.STOP if score else RefereeCommand.FORCE_START, blue_score=score),
        last_touch=BLUE_1 if tick >= 3 else None,
    )


def runners() -> dict[RobotId, TreeRunner]:
    return {BLUE_1: TreeRunner(tree(7), None), YELLOW_0: TreeRunner(tree(11), None)}


def record(path: Path, ticks: int = 120, close: bool = True) -> list[dict[RobotId, tuple[str, list[str]]]]:
    """Record a match to ``path`` and return what its trees looked like, tick by tick."""
    trees = runners()
    seen = []
    with Recorder(path, header(), trees) as recorder:
        for tick in range(ticks):
            for runner in trees.values():
                runner.tick()
            seen.append(
                {
                    robot: (runner.statuses(), [node.feedback_message for node in runner.nodes])
                    for robot, runner in trees.items()
                }
            )
            if tick == 50:
                recorder.event("goal", tick * PERIOD, team=Team.BLUE, text="1 : 0")
            if tick % 40 == 20:
                recorder.event("kick", tick * PERIOD, robot=YELLOW_0)
            commands = {BLUE_1: RobotCommand(dribbler=True), YELLOW_0: RobotCommand(kick_speed=5.0)}
            recorder.tick(frame(tick, score=int(tick >= 50)), commands)
        if close:
            recorder.close({"outcome": "goal_blue", "blue": 1})
    return seen
