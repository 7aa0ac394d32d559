"""Drive to this robot's place in the team's plan."""

from __future__ import annotations

from robobt.motion.path_planner import PATHS, TARGETS
from robobt.skills.ball.learned_control import PolicyError
from robobt.skills.base import Skill, skill
from robobt.skills.learned_way import LearnedWay
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.ways import way_to_place
from robobt.tree import Status
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point


@skill
class TakePlace(Skill):
    """Drive to the place in the team's plan, facing the ball. FAILURE without one; never ends by itself.

    With ``policy`` a trained policy drives while the ball is in play, as in :class:`GoToPose`.

    Args:
        policy: name or file of a model for GoToBall that sees the robots in its way
            (``robobt train go_to_ball_among_robots``); empty for the planner alone.

    Raises:
        ModelError: the model cannot be used; the message names the file and the reason.
    """

    reads = ("team",)
    writes = ("team",)

    policy: str = ""

    def __post_init__(self) -> None:
        super().__post_init__()
        self._learned = LearnedWay(self.policy) if self.policy else None
        self._told: Point | None = None
        self._text = ""

    def on_start(self) -> None:
        """Forget the last decision."""
        if self._learned is not None:
            self._learned.restart()

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        store = self.store
        frame, me, team = store.frame, store.me, store.team
        plan = agree(frame, team)
        place = plan.places.get(me.id)
        if place is None:
            return self.fail("no place")
        if self._learned is not None:
            try:
                command = self._learned.command(
                    frame, me, place, self.drive_limits, self.draw, avoid_ball=True
                )
            except PolicyError as error:
                store.command = RobotCommand()
                return self.fail(str(error))
            if command is not None:
                store.command = command
                return self.run("to its place as learned")
        draw = store.draw
        # Only a robot that plans its way alone draws it.
        way = None if draw.wants(PATHS) else way_to_place(frame, team, me.id)
        if way is not None:
            draw.point(TARGETS, place)
            store.command = way
        else:
            slack = plan.tactics.facing
            self.drive_to(
                place, frame.ball.position, avoid_ball=True, thereabouts=True, slack=slack, spare_mates=True
            )
        if place is not self._told:
            self._told, self._text = place, f"to ({place[0]:.1f}, {place[1]:.1f})"
        return self.run(self._text)
