"""The automatic referee: it sees what happens on the field and reports it by the league's names."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from robobt.match.referee.events import RefereeEvent
from robobt.match.referee.rules.ball_handling import BallSpeed, DoubleTouch, Dribbling
from robobt.match.referee.rules.ball_left import BallLeft
from robobt.match.referee.rules.base import Rule
from robobt.match.referee.rules.contact import Crash, Pushing
from robobt.match.referee.rules.defense_areas import DefenseAreaTouch, KeeperHeld
from robobt.match.referee.rules.penalty_kick import PenaltyKick
from robobt.match.referee.rules.placement import PlacementInterference, PlacementSucceeded
from robobt.match.referee.rules.play_goes_on import NoProgress, TooManyRobots
from robobt.match.referee.rules.restart_distances import AreaDistance, KickPointDistance, StopSpeed
from robobt.match.referee.scene import PlayPhase, RefereeScene
from robobt.match.referee.settings import RefereeSettings, in_seconds
from robobt.world.division import Division, division_of
from robobt.world.field import FieldGeometry
from robobt.world.game import GameState, Team
from robobt.world.state import Frame

CONTROLLER_SEES: tuple[type[Rule], ...] = (KeeperHeld, NoProgress, TooManyRobots)
"""Events that the league's game controller detects itself in tracked frames."""


class AutomaticReferee:
    """Detects events in a match; the same frames and states give the same events.

    It does not detect robots that tip over, lose parts or hold the ball on purpose, nor a ball that leaves
    over the walls, which no world shows.

    Args:
        field: the field, which tells the division.
        settings: what it checks; by default as in the rules.
        but: rules to leave out, because another program checks them.
    """

    def __init__(
        self,
        field: FieldGeometry,
        settings: RefereeSettings | None = None,
        but: tuple[type[Rule], ...] = (),
    ) -> None:
        settings = settings or RefereeSettings()
        self.scene = RefereeScene(field, settings)
        rules = [rule for rule in rules_of(division_of(field), settings) if not isinstance(rule, but)]
        self._rules = {phase: [rule for rule in rules if phase in rule.phases] for phase in PlayPhase}

    def watch(self, frame: Frame, game: GameState) -> Sequence[RefereeEvent]:
        """Return the events in the next frame.

        Args:
            frame: the true frame, seen from blue's side; its time increases from call to call.
            game: the state decided on the last frame; ``restart`` is None once the ball is in play.

        Raises:
            ValueError: the frame is seen from yellow's side.
        """
        if frame.team is not Team.BLUE:
            raise ValueError("the referee looks from blue's side; pass World.truth() as it is")
        scene = self.scene
        changed = scene.update(frame, game)
        rules = self._rules[scene.phase]
        if changed:
            for rule in rules:
                rule.enter(scene)
        events: list[RefereeEvent] = []
        for rule in rules:
            events += rule.check(scene)
        return events


def rules_of(division: Division, settings: RefereeSettings) -> Iterator[Rule]:
    """Return the active rules; rules that do not stop play come first."""
    if settings.crash_speed is not None:
        yield Crash(settings.crash_speed)
    if settings.max_ball_speed is not None:
        yield BallSpeed(settings.max_ball_speed)
    if settings.stop_speed is not None:
        yield StopSpeed(settings.stop_speed, settings.grace)
    if settings.stop_distance is not None:
        yield KickPointDistance(settings.stop_distance, settings.grace)
    yield BallLeft(aimless=settings.aimless_kick and division.aimless_kick)
    if settings.defense_areas:
        yield DefenseAreaTouch()
        yield AreaDistance(settings.grace)
    if settings.double_touch:
        yield DoubleTouch(settings.in_play_distance)
    if settings.max_dribble is not None:
        yield Dribbling(settings.max_dribble)
    if settings.pushing:
        yield Pushing()
    if settings.keeper_hold_time is not None:
        yield KeeperHeld(in_seconds(settings.keeper_hold_time, division))
    if settings.no_progress_time is not None:
        yield NoProgress(in_seconds(settings.no_progress_time, division), settings.no_progress_distance)
    yield TooManyRobots()
    yield PlacementSucceeded()
    yield PlacementInterference()
    yield PenaltyKick(settings.in_play_distance)
