"""What each team did, on matches written by hand."""

from __future__ import annotations

from collections.abc import Iterable

import pytest

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.results.teams import TeamResult, TeamStatistics
from robobt.world import DIVISION_B, BallState, Frame, GameState, RefereeCommand, RobotId, RobotState, Team
from robobt.world.game import TeamStatus
from robobt.world.geometry import Point
from tests.skills.refereed import OPEN, STOP, free_kick

PERIOD = 1 / 60
GAP = 0.1
"""From a robot's centre to a ball before its front [m]."""


class Story:
    """Frames told one after the other."""

    def __init__(self, blue: dict[int, Point], yellow: dict[int, Point]) -> None:
        self.blue, self.yellow, self.time = blue, yellow, 0.0
        self.statistics = TeamStatistics()
        self.touch: RobotId | None = None
        self.driving: dict[int, Point] = {}

    def frame(
        self,
        ball: Point,
        speed: Point = (0.0, 0.0),
        game: GameState = OPEN,
        events: Iterable[RefereeEvent] = (),
    ) -> None:
        own = tuple(
            RobotState(number, *place, 0.0, *self.driving.get(number, (0.0, 0.0)))
            for number, place in self.blue.items()
        )
        theirs = tuple(RobotState(number, *place, 3.14) for number, place in self.yellow.items())
        seen = Frame(
            self.time,
            DIVISION_B,
            BallState(*ball, *speed),
            own,
            theirs,
            Team.BLUE,
            PERIOD,
            game,
            last_touch=self.touch,
        )
        self.statistics.update(seen, game, events)
        self.time += PERIOD

    def kick(self, start: Point, end: Point, speed: float = 4.0) -> None:
        """The ball goes straight from one place to another."""
        dx, dy = end[0] - start[0], end[1] - start[1]
        length = (dx * dx + dy * dy) ** 0.5
        velocity = (speed * dx / length, speed * dy / length)
        steps = max(2, round(length / speed / PERIOD))
        for step in range(1, steps + 1):
            self.frame((start[0] + step / steps * dx, start[1] + step / steps * dy), velocity)

    def of(self, team: Team) -> TeamResult:
        return self.statistics.result()[team.value]


def match() -> Story:
    return Story({1: (0.0, 0.0), 2: (0.0, 2.0)}, {0: (4.4, 0.0), 1: (-3.0, 0.0)})


def test_a_pass_that_arrives_is_completed() -> None:
    story = match()
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (0.02, 2.0 - GAP))
    story.frame((0.02, 2.0 - GAP))
    blue = story.of(Team.BLUE)
    assert (blue.passes, blue.passes_completed, blue.passes_intercepted) == (1, 1, 0)


def test_a_pass_that_an_opponent_touches_is_intercepted() -> None:
    story = match()
    story.yellow[1] = (0.0, 1.0)
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (0.02, 1.0 - GAP))
    story.frame((0.02, 1.0 - GAP))
    blue = story.of(Team.BLUE)
    assert (blue.passes, blue.passes_completed, blue.passes_intercepted) == (1, 0, 1)


def test_a_pass_that_leaves_the_field_is_tried_but_neither() -> None:
    story = match()
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (0.6, 3.1))
    story.frame((0.6, 3.2))
    blue = story.of(Team.BLUE)
    assert (blue.passes, blue.passes_completed, blue.passes_intercepted) == (1, 0, 0)


def test_a_pass_sent_on_between_two_frames_arrived_and_the_shot_is_the_receivers() -> None:
    story = match()
    story.touch = RobotId(Team.BLUE, 1)
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (0.02, 1.8))
    story.touch = RobotId(Team.BLUE, 2)
    story.kick((0.15, 1.9), (4.4, 0.1), 6.0)
    blue = story.of(Team.BLUE)
    assert (blue.passes, blue.passes_completed, blue.shots_on_goal) == (1, 1, 1)


def test_a_ball_that_bounces_off_a_robot_towards_a_team_mate_is_no_pass() -> None:
    story = match()
    story.kick((1.0, 0.0), (GAP, 0.0), 4.0)
    story.kick((GAP, 0.0), (0.02, 1.8), 2.0)
    assert story.of(Team.BLUE).passes == 0
    story.frame((0.02, 2.0 - GAP))
    assert story.of(Team.BLUE).passes == 0


def test_a_clearance_towards_nobody_is_no_pass() -> None:
    story = match()
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (3.0, -2.5))
    assert story.of(Team.BLUE).passes == 0


def test_a_ball_that_rolls_off_slowly_is_no_pass() -> None:
    story = match()
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), (0.02, 2.0 - GAP), speed=0.6)
    assert story.of(Team.BLUE).passes == 0


@pytest.mark.parametrize(("speed", "passes"), [(1.8, 0), (3.5, 1)])
def test_a_ball_that_slips_from_a_robot_in_drive_was_not_kicked(speed: float, passes: int) -> None:
    story = match()
    story.driving[1] = (0.0, 1.5)
    story.frame((0.0, GAP))
    story.kick((0.0, GAP), (0.02, 2.0 - GAP), speed)
    story.frame((0.02, 2.0 - GAP))
    assert story.of(Team.BLUE).passes == passes


@pytest.mark.parametrize(
    ("end", "shots"), [((4.5, 0.4), 1), ((4.5, 0.7), 0)], ids=["inside", "past the post"]
)
def test_a_shot_on_goal_leads_between_the_posts(end: Point, shots: int) -> None:
    story = match()
    story.frame((GAP, 0.0))
    story.kick((GAP, 0.0), end, speed=6.0)
    blue = story.of(Team.BLUE)
    assert blue.shots_on_goal == shots
    assert 0.0 <= blue.expected_goals <= shots
    assert blue.passes == 0


def test_an_empty_goal_is_expected_to_let_more_in() -> None:
    chances = []
    for keeper in ((4.4, 0.3), (-4.4, 0.0)):
        story = match()
        story.yellow[0] = keeper
        story.frame((GAP, 0.0))
        story.kick((GAP, 0.0), (4.5, 0.3), speed=6.0)
        chances.append(story.of(Team.BLUE).expected_goals)
    assert chances[0] < 0.5 < chances[1]


def test_possession_is_the_share_of_play_since_a_teams_touch() -> None:
    story = match()
    for _ in range(30):
        story.frame((GAP, 0.0))
    for _ in range(10):
        story.frame((-3.0 - GAP, 0.0))
    assert story.of(Team.BLUE).possession == pytest.approx(0.75)
    assert story.of(Team.YELLOW).possession == pytest.approx(0.25)


@pytest.mark.parametrize(("receiver", "kept"), [(Team.BLUE, 1), (Team.YELLOW, 0)])
def test_a_free_kick_is_kept_when_a_team_mate_is_next_on_the_ball(receiver: Team, kept: int) -> None:
    story = match()
    if receiver is Team.YELLOW:
        story.yellow[1], story.blue[2] = (0.0, 2.0), (-2.0, -2.0)
    spot = (GAP, 0.0)
    story.frame(spot, game=free_kick(Team.BLUE, spot))
    story.kick(spot, (0.02, 2.0 - GAP))
    story.frame((0.02, 2.0 - GAP))
    blue = story.of(Team.BLUE)
    assert (blue.restarts, blue.restarts_kept) == (1, kept)


def test_a_free_kick_that_nobody_takes_goes_to_whoever_touches_first() -> None:
    story = match()
    spot = (1.0, -1.0)
    story.frame(spot, game=free_kick(Team.BLUE, spot))
    story.frame(spot)
    story.yellow[1] = (1.0 + GAP, -1.0)
    story.frame(spot)
    blue = story.of(Team.BLUE)
    assert (blue.restarts, blue.restarts_kept) == (1, 0)


def test_fouls_cards_and_placements_are_the_referees() -> None:
    story = match()
    crash = RefereeEvent(0.0, EventKind.BOT_CRASH_UNIQUE, Team.YELLOW)
    out = RefereeEvent(0.0, EventKind.BALL_LEFT_FIELD_TOUCH_LINE, Team.YELLOW)
    story.frame((0.0, -2.0), events=[crash, out])
    story.frame((0.0, -2.0), game=GameState(RefereeCommand.STOP, yellow=TeamStatus(yellow_cards=1)))
    placed = RefereeEvent(0.0, EventKind.PLACEMENT_SUCCEEDED, Team.BLUE)
    story.frame((0.0, -2.0), game=STOP, events=[placed])
    yellow = story.of(Team.YELLOW)
    assert (yellow.fouls, yellow.yellow_cards, story.of(Team.BLUE).placements_succeeded) == (1, 1, 1)


def test_the_way_that_robots_drive_is_added_up_but_not_where_they_are_put() -> None:
    story = match()
    for place in ((0.0, 0.0), (0.1, 0.0), (-4.0, 0.0)):
        story.blue[1] = place
        for _ in range(7):
            story.frame((1.0, 1.0))
    assert story.of(Team.BLUE).distance == pytest.approx(0.1)
