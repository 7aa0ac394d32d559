"""What follows from what happens, told from the acting team's side and played for both colours."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.match.referee.referee import Referee
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.state import BallState, Frame, RobotId, RobotState

FIELD = DIVISION_B
GOAL_LINE = FIELD.half_length
TOUCH_LINE = FIELD.half_width
PERIOD = 0.02
BY_HAND = RefereeSettings(stop_time=0.5, placement="by_hand", placement_delay=0.2, kickoff_wait=5.0)
KICKOFF = BY_HAND
OPEN = KICKOFF.model_copy(update={"opening": "force_start"})


class Story:
    """Frames by hand, one after another, from the side of ``us``.

    Robots stand where they are put; the ball moves when told to.
    """

    def __init__(self, us: Team, settings: RefereeSettings = OPEN, field: FieldGeometry = FIELD) -> None:
        self.us = us
        self.them = us.other
        self.referee = Referee(field, settings.model_copy(update={"opening_team": us}))
        self.field = field
        self.time = 0.0
        self.ball = BallState(0.0, 0.0)
        self.own: dict[int, RobotState] = {}
        self.opponents: dict[int, RobotState] = {}
        self.touched: RobotId | None = None
        self.events: list[tuple[EventKind, Team | None]] = []
        self.placed: tuple[float, float] | None = None

    @property
    def game(self) -> GameState:
        """The game state from our side."""
        game = self.referee.game
        return game if self.us is Team.BLUE else game.mirrored()

    @property
    def score(self) -> tuple[int, int]:
        """Our goals and theirs."""
        both = (self.game.blue_score, self.game.yellow_score)
        return both if self.us is Team.BLUE else (both[1], both[0])

    @property
    def kinds(self) -> list[EventKind]:
        return [kind for kind, _ in self.events]

    def ours(self, number: int, x: float, y: float, **more: float) -> Story:
        self.own[number] = RobotState(number, x, y, **more)
        return self

    def theirs(self, number: int, x: float, y: float, **more: float) -> Story:
        self.opponents[number] = RobotState(number, x, y, **more)
        return self

    def touch(self, number: int, by: Team | None = None) -> Story:
        self.touched = RobotId(by or self.us, number)
        return self

    def roll(self, x: float, y: float, vx: float = 0.0, vy: float = 0.0) -> Story:
        """The ball is at (x, y) in the next frame."""
        self.ball = BallState(x, y, vx, vy)
        return self.tick()

    def tick(self) -> Story:
        view = Frame(
            self.time,
            self.field,
            self.ball,
            tuple(self.own.values()),
            tuple(self.opponents.values()),
            self.us,
            PERIOD,
            last_touch=self.touched,
        )
        decision = self.referee.update(view.seen_by(Team.BLUE))
        self.time += PERIOD
        self.events += [(event.kind, event.team) for event in decision.events]
        if decision.place_ball is not None:
            x, y = decision.place_ball
            self.placed = (x, y) if self.us is Team.BLUE else (-x, -y)
            self.ball = BallState(*self.placed)
        return self

    def wait(self, seconds: float) -> Story:
        for _ in range(round(seconds / PERIOD)):
            self.tick()
        return self


@pytest.fixture
def story(us: Team) -> Story:
    """Open play, the ball at rest in the middle, touched by nobody."""
    return Story(us).tick()


def approx(point: tuple[float, float]) -> object:
    return pytest.approx(point, abs=1e-9)


# Goals.


def test_after_a_goal_the_conceding_team_kicks_off(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.05, 0.0).roll(GOAL_LINE + 0.05, 0.0)
    assert story.events == [(EventKind.POSSIBLE_GOAL, story.us), (EventKind.GOAL, story.us)]
    assert story.score == (1, 0)
    assert story.game.command is RefereeCommand.STOP
    assert (story.game.restart, story.game.restart_team) == (Restart.KICKOFF, story.them)
    assert not story.game.may_touch
    story.wait(1.0)
    assert story.placed == approx((0.0, 0.0))
    assert story.game.command is RefereeCommand[f"PREPARE_KICKOFF_{story.them.name}"]


def test_a_goal_counts_once_while_the_ball_lies_in_the_net(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"placement_delay": 3.0})).tick()
    story.touch(1).roll(GOAL_LINE - 0.05, 0.0).roll(GOAL_LINE + 0.05, 0.0).wait(2.0)
    assert story.score == (1, 0)


# The ball leaves the field.


def test_a_ball_out_that_nobody_touched_is_free_for_both(story: Story) -> None:
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05)
    assert (story.game.restart, story.game.upcoming) == (None, RefereeCommand.FORCE_START)
    story.wait(1.0)
    assert story.game.command is RefereeCommand.FORCE_START
    assert story.placed == approx((1.0, TOUCH_LINE - 0.2))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_an_attackers_ball_over_the_goal_line_is_a_goal_kick(story: Story, side: float) -> None:
    story.touch(1).roll(1.0, 1.5 * side).roll(GOAL_LINE + 0.05, 1.5 * side)
    assert story.game.restart_team is story.them
    assert story.game.placement == approx((GOAL_LINE - 1.0, (TOUCH_LINE - 0.2) * side))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_defenders_ball_over_the_goal_line_is_a_corner(story: Story, side: float) -> None:
    story.touch(1, story.them).roll(1.0, 1.5 * side).roll(GOAL_LINE + 0.05, 1.5 * side)
    assert story.game.restart_team is story.us
    assert story.game.placement == approx((GOAL_LINE - 0.2, (TOUCH_LINE - 0.2) * side))


def test_an_aimless_kick_comes_back_to_where_it_was_kicked(story: Story) -> None:
    story.ours(1, -2.11, 1.0).touch(1).roll(-2.0, 1.0).roll(-1.8, 1.0, 6.0)
    story.roll(GOAL_LINE - 0.05, 1.0, 3.0).roll(GOAL_LINE + 0.05, 1.0, 3.0)
    assert story.events == [(EventKind.AIMLESS_KICK, story.us)]
    assert story.game.restart_team is story.them
    assert story.game.placement == approx((-2.0, 1.0))


# Restarts.


def throw_in(story: Story) -> Story:
    """They put the ball out at (1, touch line); the free kick is ours and may be taken."""
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(0.8)
    assert story.game.may_touch
    assert story.game.restart is Restart.FREE_KICK
    return story


SPOT = (1.0, TOUCH_LINE - 0.2)


def test_the_ball_lies_for_its_time_before_a_free_kick(story: Story) -> None:
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05)
    story.wait(0.66)
    assert story.game.stopped
    story.wait(0.1)
    free = RefereeCommand.DIRECT_FREE_BLUE if story.us is Team.BLUE else RefereeCommand.DIRECT_FREE_YELLOW
    assert story.game.command is free
    assert not story.game.in_play


def test_a_hand_does_not_put_the_ball_into_a_robot(story: Story) -> None:
    story.touch(3, story.them).ours(1, 1.0 - 0.11, SPOT[1])
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(1.0)
    assert story.placed is None
    story.ours(1, 1.0 - 0.14, SPOT[1]).wait(0.1)
    assert story.placed == approx(SPOT)


def test_a_robot_that_never_moves_does_not_hold_up_a_hand(story: Story) -> None:
    story.touch(3, story.them).ours(1, 1.0, TOUCH_LINE - 0.25)
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(4.5)
    assert story.placed == approx(SPOT)
    assert story.game.may_touch


def test_a_ball_nudged_in_stop_is_put_back(story: Story) -> None:
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(0.3)
    story.placed = None
    story.roll(SPOT[0] + 0.1, SPOT[1]).tick()
    assert story.placed == approx(SPOT)


@pytest.mark.parametrize(("way", "played"), [(0.049, False), (0.051, True)])
def test_the_ball_is_in_play_once_it_has_moved_five_centimetres(
    story: Story, way: float, played: bool
) -> None:
    throw_in(story).touch(1).roll(SPOT[0] - way, SPOT[1])
    assert story.game.in_play is played
    assert (story.game.restart is None) is played


@pytest.mark.parametrize(("field", "limit"), [(DIVISION_A, 5.0), (DIVISION_B, 10.0)], ids=["a", "b"])
def test_a_free_kick_not_taken_in_time_is_over(us: Team, field: FieldGeometry, limit: float) -> None:
    settings = OPEN.model_copy(update={"opening": "free_kick", "opening_spot": (0.0, 0.0)})
    story = Story(us, settings, field).wait(0.8)
    assert story.game.restart is Restart.FREE_KICK
    story.wait(limit - 0.4)
    assert not story.game.in_play
    story.wait(0.5)
    assert story.game.in_play


def test_opponents_that_crowd_the_ball_give_the_kicker_more_time(story: Story) -> None:
    throw_in(story).wait(8.0).theirs(3, SPOT[0], SPOT[1] - 0.4).tick()
    assert story.kinds[-1] is EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT
    assert story.game.action_time == pytest.approx(10.0, abs=0.05)
    story.theirs(3, SPOT[0], SPOT[1] - 2.0).wait(9.8)
    assert not story.game.in_play
    story.wait(0.3)
    assert story.game.in_play


# Kick-off.


def test_a_match_begins_with_the_kick_off_of_the_first_team(us: Team) -> None:
    story = Story(us, KICKOFF).theirs(0, 4.4, 0.0).tick()
    kickoff = (
        RefereeCommand.PREPARE_KICKOFF_BLUE if us is Team.BLUE else RefereeCommand.PREPARE_KICKOFF_YELLOW
    )
    assert story.game.command is kickoff
    assert story.game.stage is Stage.NORMAL_FIRST_HALF_PRE
    assert not story.game.may_touch
    story.wait(0.6)
    assert story.game.command is RefereeCommand.NORMAL_START
    assert story.game.stage is Stage.NORMAL_FIRST_HALF
    assert story.game.may_touch
    assert not story.game.in_play


@pytest.mark.parametrize(("x", "fair"), [(-0.089, False), (-0.091, True)])
@pytest.mark.parametrize("y", [0.1, 1.5], ids=["in the circle", "outside"])
def test_a_kick_off_waits_until_everybody_is_in_the_own_half(
    us: Team, x: float, y: float, fair: bool
) -> None:
    story = Story(us, KICKOFF).ours(1, x, y).wait(1.0)
    assert story.game.may_touch is fair
    story = Story(us, KICKOFF).theirs(1, -x, y).wait(1.0)
    assert story.game.may_touch is fair


def test_a_kick_off_waits_for_ever_or_as_long_as_it_is_told(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, 0.5, 1.0).wait(4.9)
    assert not story.game.may_touch
    assert story.wait(0.2).game.may_touch
    patient = Story(us, KICKOFF.model_copy(update={"kickoff_wait": None})).ours(1, 0.5, 1.0)
    assert not patient.wait(60.0).game.may_touch


def test_a_kick_off_not_taken_within_ten_seconds_is_over(us: Team) -> None:
    story = Story(us, KICKOFF).wait(0.7)
    assert not story.wait(9.6).game.in_play
    assert story.wait(0.4).game.in_play


def test_a_ball_moved_before_the_kick_off_is_put_back(us: Team) -> None:
    story = Story(us, KICKOFF).ours(2, 0.2, 0.4).ours(1, -0.2, 0.0).tick()
    story.touch(1).roll(0.2, 0.0, 1.0)
    assert story.game.stopped
    story.wait(0.3)
    assert story.placed == approx((0.0, 0.0))


def test_a_goal_straight_from_the_kick_off_counts(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, -0.2, 0.0).wait(0.6)
    assert story.game.may_touch
    story.touch(1).roll(1.0, 0.0, 6.0).roll(4.4, 0.0, 6.0).roll(4.53, 0.0, 6.0)
    assert story.score == (1, 0)


def test_the_keeper_is_the_robot_the_settings_name(us: Team) -> None:
    settings = OPEN.model_copy(update={f"{us.value}_keeper": 3, f"{us.other.value}_keeper": 4})
    story = Story(us, settings).wait(0.6)
    assert story.game.status(us).keeper == 3
    story.ours(3, -GOAL_LINE + 0.5, 0.3).touch(3).roll(-GOAL_LINE + 0.597, 0.3)
    assert story.events == []
    story.ours(0, -GOAL_LINE + 0.5, -0.3).ours(3, -2.0, 0.0).touch(0).roll(-GOAL_LINE + 0.597, -0.3)
    assert story.kinds == [EventKind.DEFENDER_IN_DEFENSE_AREA]


def test_the_same_frames_give_the_same_decisions(us: Team) -> None:
    def tell() -> tuple[list[tuple[EventKind, Team | None]], GameState]:
        story = throw_in(Story(us).tick()).touch(1).roll(0.5, 2.0).roll(-GOAL_LINE - 0.03, 0.0).wait(3.0)
        return story.events, story.referee.game

    assert tell() == tell()


def test_a_frame_from_yellows_side_is_refused() -> None:
    view = Frame(0.0, FIELD, BallState(0.0, 0.0), team=Team.YELLOW)
    with pytest.raises(ValueError, match="blue's side"):
        Referee(FIELD).update(view)
