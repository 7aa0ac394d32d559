"""The passing challenge of 2025: two teams of four try to play more passes than the other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

from robobt.challenges.challenge import CHALLENGES, ChallengeAttempt, Figures, FixedChallenge
from robobt.challenges.passes import PassCounter
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.referee import Referee
from robobt.match.referee.restarts import Resumption, kickoff
from robobt.match.referee.settings import RefereeSettings
from robobt.match.refereeing import referee_settings
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import GameState, Stage, Team
from robobt.world.geometry import Point
from robobt.world.state import Frame

HALF_LENGTH = 120.0
"""Playing time of each half [s]. Source: the challenge's rules of 2025."""

NO_PROGRESS = 10.0
"""Time without progress after which there is a kick-off [s]. Source: as above."""

FIELD = DIVISION_B.model_copy(update={"defense_width": 0.01, "defense_depth": 0.01})
"""Division B's field. The challenge has no rules about defence areas, so plays are shown none to avoid."""

OPPONENT = "field_player_2026_11"
"""The team that all entrants meet, its shots switched off: a goal is no pass, and there is no goalkeeper."""

_HALF_TIME = 2.0
"""Break between the halves [s]; the rules' 60 s serve people."""

_KICKOFF_WAIT = 15.0
"""Longest wait for robots to take their positions at a kick-off [s]; the rules have no limit."""

_LEFT = frozenset(
    {
        EventKind.POSSIBLE_GOAL,
        EventKind.BALL_LEFT_FIELD_TOUCH_LINE,
        EventKind.BALL_LEFT_FIELD_GOAL_LINE,
    }
)


class PassingReferee(Referee):
    """Referees the passing challenge.

    A ball that leaves the field, also into a goal, is a kick-off for the team that did not touch it last. A
    ball without progress is a kick-off for the team that began the half. Fouls are those that the
    challenge keeps, with the free kicks of the rules.
    """

    def watch(self, frame: Frame) -> Sequence[RefereeEvent]:
        """Return the events in the next frame, with a goal as a ball that left over the goal line."""
        last = None if frame.last_touch is None else frame.last_touch.team
        return [
            replace(event, kind=EventKind.BALL_LEFT_FIELD_GOAL_LINE, team=last, details={})
            if event.kind is EventKind.POSSIBLE_GOAL
            else event
            for event in super().watch(frame)
        ]

    def resumption_after(self, event: RefereeEvent, ball: Point) -> Resumption | None:
        """Return the restart after an event that stops play, else None.

        Args:
            event: the event while the ball was in play.
            ball: the ball's position now [m].
        """
        controller = self.controller
        second = controller is not None and controller.state.stages.stage is Stage.NORMAL_SECOND_HALF
        opening = self.settings.opening_team
        first = opening.other if second else opening
        if event.kind in _LEFT:
            return kickoff(first if event.team is None else event.team.other)
        if event.kind is EventKind.NO_PROGRESS_IN_GAME:
            return kickoff(first)
        return super().resumption_after(event, ball)


def passing_referee(scenario: Scenario, field: FieldGeometry) -> PassingReferee:
    """Return the referee of the passing challenge for a scenario on a field."""
    return PassingReferee(field, referee_settings(scenario))


class PassingJudge:
    """Counts the passes of both teams."""

    def __init__(self) -> None:
        self._counter = PassCounter()

    def see(self, frame: Frame, game: GameState) -> bool:
        """Take in the next true frame; only the referee ends the match."""
        self._counter.see(frame, game)
        return False

    def figures(self) -> Figures:
        """Return blue's passes, yellow's, and the difference, by which the challenge of 2025 ranks."""
        blue, yellow = (self._counter.passes[team] for team in Team)
        return {"passes": blue, "opponent's": yellow, "difference": blue - yellow}


@CHALLENGES.register("passing")
class Passing(FixedChallenge):
    """Play as many passes of at least 1 m as possible in two halves of two minutes, four against four."""

    title = "Passes against another team, 4 against 4, two halves of 2 min"
    source = "RoboCup 2025 Team vs. Team Passing Challenge, robocup-ssl/technical-challenge-rules c5e6bfd"
    unit = "passes"
    entrants: ClassVar[Mapping[str, str]] = {
        "ours": "pass_player",
        "november": "field_player_2026_11:shot_distance=0",
        "script": "go_to_ball_and_shoot",
        "chance": "stand_still",
    }
    opponent = True

    def fixed_attempts(self) -> Sequence[ChallengeAttempt]:
        """Return the match."""
        places = [((-0.9, 0.0), 0.2), ((-1.2, 1.5), 0.5), ((-1.2, -1.5), 0.5), ((-3.0, 0.0), 0.5)]

        def team(play: str, **params: object) -> list[dict[str, object]]:
            return [
                {
                    "number": number,
                    "play": play,
                    "params": params,
                    "start": {"position": {"center": at, "radius": radius}},
                }
                for number, (at, radius) in enumerate(places)
            ]

        settings = RefereeSettings(
            opening_team=Team.YELLOW,
            placement="by_hand",
            half_length=HALF_LENGTH,
            half_time=_HALF_TIME,
            kickoff_wait=_KICKOFF_WAIT,
            no_progress_time=NO_PROGRESS,
            max_robots=4,
            defense_areas=False,
            aimless_kick=False,
            double_touch=False,
            keeper_hold_time=None,
            pushing=True,
        )
        scenario = scenario_from(
            {
                "name": "passing",
                "description": self.title,
                "field": FIELD.model_dump(),
                "period": 1.0 / 60.0,
                "robots": {
                    "blue": team("stand_still"),
                    "yellow": team(OPPONENT, shot_distance=0.0),
                },
                "referee": settings.model_dump(mode="json", exclude_unset=True),
                "ends": {"time_limit": 1800},
            },
            "passing",
        )
        return [ChallengeAttempt("match", scenario, PassingJudge, passing_referee)]

    def score(self, attempts: Sequence[Figures]) -> Figures:
        """Return the figures of the match."""
        return attempts[0]
