"""Every rule as a statement, told from the acting team's side and played for both colours."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.match.referee.referee import Referee
from robobt.match.referee.restarts import penalty
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

FIELD = DIVISION_B
GOAL_LINE = FIELD.half_length
TOUCH_LINE = FIELD.half_width
PERIOD = 0.02
KICKOFF = RefereeSettings(stop_time=0.5, placement_delay=0.2, kickoff_wait=5.0)
OPEN = KICKOFF.model_copy(update={"opening": "force_start"})


class Story:
    """Frames by hand, one after another, from the side of ``us``.

    Robots stand where they are put; the ball moves when told to.
    """

    def __init__(self, us: Team, settings: RefereeSettings = OPEN, field: FieldGeometry = FIELD) -> None:
        self.us = us
        self.them = us.other
        self.referee = Referee(field, settings, first_kickoff=us)
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


@pytest.fixture(params=list(Team), ids=[team.value for team in Team])
def us(request: pytest.FixtureRequest) -> Team:
    return request.param


@pytest.fixture
def story(us: Team) -> Story:
    """Open play, the ball at rest in the middle, touched by nobody."""
    return Story(us).tick()


def approx(point: tuple[float, float]) -> object:
    return pytest.approx(point, abs=1e-9)


def test_a_match_can_begin_with_the_ball_in_play(us: Team) -> None:
    story = Story(us).tick()
    assert (story.game.command, story.game.stage) == (RefereeCommand.FORCE_START, Stage.NORMAL_FIRST_HALF)
    assert story.game.in_play


# Goals.


def test_a_ball_fully_over_the_line_between_the_posts_is_a_goal(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.05, 0.2).roll(GOAL_LINE + BALL_RADIUS + 0.001, 0.2)
    assert story.events == [(EventKind.GOAL, story.us)]
    assert story.score == (1, 0)


def test_a_ball_a_millimetre_short_of_fully_over_the_line_is_no_goal(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.05, 0.2).roll(GOAL_LINE + BALL_RADIUS - 0.001, 0.2)
    assert story.events == []
    assert story.game.in_play


@pytest.mark.parametrize(("y", "goal"), [(0.478, True), (-0.478, True), (0.5415, False), (-0.5415, False)])
def test_a_ball_at_the_post_scores_only_on_its_inner_side(story: Story, y: float, goal: bool) -> None:
    story.touch(1).roll(GOAL_LINE - 0.05, y).roll(GOAL_LINE + 0.04, y)
    assert story.score == ((1, 0) if goal else (0, 0))
    assert story.kinds == [EventKind.GOAL if goal else EventKind.BALL_LEFT_FIELD_GOAL_LINE]


def test_where_the_ball_crossed_the_line_counts_not_where_it_is_seen_next(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.03, 0.58).roll(GOAL_LINE + 0.1, 0.42)
    assert story.kinds == [EventKind.BALL_LEFT_FIELD_GOAL_LINE]


def test_an_own_goal_counts_for_the_other_team(story: Story) -> None:
    story.touch(1).roll(-GOAL_LINE + 0.05, 0.0).roll(-GOAL_LINE - 0.05, 0.0)
    assert story.events == [(EventKind.GOAL, story.them)]
    assert story.score == (0, 1)


def test_after_a_goal_the_conceding_team_kicks_off(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.05, 0.0).roll(GOAL_LINE + 0.05, 0.0)
    assert story.game.command is RefereeCommand.STOP
    assert (story.game.restart, story.game.restart_team) == (Restart.KICKOFF, story.them)
    assert not story.game.may_touch
    story.wait(1.0)
    assert story.placed == (0.0, 0.0)
    assert story.game.command in (RefereeCommand.PREPARE_KICKOFF_BLUE, RefereeCommand.NORMAL_START)


def test_a_goal_counts_once_while_the_ball_lies_in_the_net(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"placement_delay": 3.0})).tick()
    story.touch(1).roll(GOAL_LINE - 0.05, 0.0).roll(GOAL_LINE + 0.05, 0.0).wait(2.0)
    assert story.score == (1, 0)


def test_a_goal_within_two_seconds_of_the_scorers_foul_does_not_count(story: Story) -> None:
    story.touch(1).roll(2.0, 0.0, 7.0).roll(2.14, 0.0, 6.0).roll(4.3, 0.0, 6.0).roll(GOAL_LINE + 0.05, 0.0)
    assert story.events == [
        (EventKind.BOT_KICKED_BALL_TOO_FAST, story.us),
        (EventKind.INVALID_GOAL, story.us),
    ]
    assert story.score == (0, 0)
    assert (story.game.restart, story.game.restart_team) == (Restart.FREE_KICK, story.them)


def test_a_goal_more_than_two_seconds_after_the_foul_counts(story: Story) -> None:
    story.touch(1).roll(2.0, 0.0, 7.0).roll(2.14, 0.0, 6.0).wait(2.1).roll(4.3, 0.0).roll(
        GOAL_LINE + 0.05, 0.0
    )
    assert story.score == (1, 0)


# The ball leaves the field.


def test_a_ball_fully_over_the_touch_line_gives_the_others_a_free_kick_there(story: Story) -> None:
    story.touch(1).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + BALL_RADIUS + 0.001)
    assert story.events == [(EventKind.BALL_LEFT_FIELD_TOUCH_LINE, story.us)]
    assert (story.game.restart, story.game.restart_team) == (Restart.FREE_KICK, story.them)
    assert story.game.placement == approx((1.0, TOUCH_LINE - 0.2))


def test_a_ball_that_still_overlaps_the_touch_line_is_in(story: Story) -> None:
    story.touch(1).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + BALL_RADIUS - 0.001)
    assert story.events == []


def test_a_ball_over_the_touch_line_beside_the_corner_is_no_goal_kick(story: Story) -> None:
    story.touch(1).roll(GOAL_LINE - 0.01, TOUCH_LINE - 0.05).roll(GOAL_LINE, TOUCH_LINE + 0.05)
    assert story.game.placement == approx((GOAL_LINE - 0.2, TOUCH_LINE - 0.2))


def test_a_ball_out_that_nobody_touched_is_free_for_both(story: Story) -> None:
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05)
    assert story.game.restart is None
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


def test_a_touch_on_the_way_makes_a_long_kick_no_aimless_one(story: Story) -> None:
    story.ours(1, -2.11, 1.0).touch(1).roll(-2.0, 1.0).touch(2).roll(2.0, 1.0)
    story.roll(GOAL_LINE - 0.05, 1.0).roll(GOAL_LINE + 0.05, 1.0)
    assert story.kinds == [EventKind.BALL_LEFT_FIELD_GOAL_LINE]


@pytest.mark.parametrize(("field", "to_goal"), [(DIVISION_A, 8.0), (DIVISION_B, 6.0)], ids=["a", "b"])
def test_the_penalty_mark_is_where_the_rules_put_it(field: FieldGeometry, to_goal: float) -> None:
    assert penalty(field, Team.BLUE).spot == pytest.approx((field.half_length - to_goal, 0.0))
    assert penalty(field, Team.YELLOW).spot == pytest.approx((to_goal - field.half_length, 0.0))


# Restarts.


def throw_in(story: Story) -> Story:
    """They put the ball out at (1, touch line); the free kick is ours and may be taken."""
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(0.7)
    assert story.game.may_touch
    assert story.game.restart is Restart.FREE_KICK
    return story


SPOT = (1.0, TOUCH_LINE - 0.2)


def test_a_stop_lasts_its_time_before_a_free_kick(story: Story) -> None:
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05)
    story.wait(0.46)
    assert story.game.stopped
    story.wait(0.1)
    free = RefereeCommand.DIRECT_FREE_BLUE if story.us is Team.BLUE else RefereeCommand.DIRECT_FREE_YELLOW
    assert story.game.command is free
    assert not story.game.in_play


def test_the_ball_is_not_put_down_into_a_robot(story: Story) -> None:
    story.touch(3, story.them).ours(1, 1.0 - 0.11, SPOT[1])
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(1.0)
    assert story.placed is None
    story.ours(1, 1.0 - 0.14, SPOT[1]).wait(0.1)
    assert story.placed == approx(SPOT)


def test_a_robot_that_never_moves_does_not_hold_up_the_match(story: Story) -> None:
    story.touch(3, story.them).ours(1, 1.0, TOUCH_LINE - 0.25)
    story.roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(4.0)
    assert story.placed == approx(SPOT)
    assert story.game.may_touch


def test_a_ball_nudged_in_stop_is_put_back(story: Story) -> None:
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(0.3)
    story.placed = None
    story.roll(SPOT[0] + 0.1, SPOT[1]).tick()
    assert story.placed == approx(SPOT)


def test_the_ball_is_in_play_once_it_has_moved_five_centimetres(story: Story) -> None:
    throw_in(story).touch(1).roll(SPOT[0] - 0.049, SPOT[1])
    assert not story.game.in_play
    story.roll(SPOT[0] - 0.051, SPOT[1])
    assert story.game.in_play
    assert story.game.restart is None
    assert story.game.placement is None


def test_a_free_kick_not_taken_in_time_is_over(us: Team) -> None:
    story = throw_in(Story(us, OPEN.model_copy(update={"kick_timeout": 2.0})).tick())
    story.wait(1.6)
    assert not story.game.in_play
    story.wait(0.5)
    assert story.game.in_play


def test_the_others_moving_the_ball_first_repeats_the_free_kick(story: Story) -> None:
    throw_in(story).touch(2, story.them).roll(SPOT[0] - 0.1, SPOT[1])
    assert story.game.stopped
    assert story.game.restart_team is story.us


def test_a_second_touch_by_the_kicker_is_a_free_kick_for_the_others(story: Story) -> None:
    throw_in(story).touch(1).roll(0.5, 2.0)
    story.roll(0.4, 2.0)
    story.ours(1, 0.4 - ROBOT_RADIUS - BALL_RADIUS, 2.0, heading=3.0).tick()
    assert story.events[-1] == (EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, story.us)
    assert story.game.restart_team is story.them
    assert story.game.placement == approx((0.4, 2.0))


def test_a_second_touch_counts_near_the_spot_too_once_the_kicker_has_let_go(story: Story) -> None:
    def at(x: float) -> Story:
        return story.ours(1, x + ROBOT_RADIUS + BALL_RADIUS, SPOT[1])

    x = SPOT[0] - 0.06
    throw_in(story).touch(1)
    at(x).roll(x, SPOT[1])
    assert story.game.in_play
    at(x + 0.05).tick()
    assert EventKind.ATTACKER_DOUBLE_TOUCHED_BALL not in story.kinds
    at(x).tick()
    assert story.events[-1] == (EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, story.us)


def test_a_second_touch_after_another_robots_is_allowed(story: Story) -> None:
    throw_in(story).touch(1).roll(0.5, 2.0).touch(2).roll(0.4, 2.0)
    story.ours(1, 0.4 - ROBOT_RADIUS - BALL_RADIUS, 2.0, heading=3.0).touch(1).tick()
    assert EventKind.ATTACKER_DOUBLE_TOUCHED_BALL not in story.kinds


def test_a_kicker_that_pushes_the_ball_along_touches_it_twice(story: Story) -> None:
    throw_in(story).touch(1)
    for step in range(8):
        x = SPOT[0] - 0.02 * step
        story.ours(1, x + 0.097, SPOT[1], heading=3.14159, ball_contact=True).roll(x, SPOT[1])
    assert story.events[-1] == (EventKind.ATTACKER_DOUBLE_TOUCHED_BALL, story.us)


def test_a_kick_is_no_double_touch_while_the_ball_leaves_the_mouth(story: Story) -> None:
    throw_in(story).touch(1).ours(1, SPOT[0] + 0.097, SPOT[1], heading=3.14159, ball_contact=True)
    story.roll(SPOT[0] - 0.06, SPOT[1], -5.0)
    story.own[1].ball_contact = False
    story.roll(SPOT[0] - 0.16, SPOT[1], -5.0)
    assert story.game.in_play
    assert EventKind.ATTACKER_DOUBLE_TOUCHED_BALL not in story.kinds


def test_a_ball_kicked_straight_out_in_one_frame_is_out(story: Story) -> None:
    throw_in(story).touch(1).roll(SPOT[0], TOUCH_LINE + 0.05)
    assert story.events[-1] == (EventKind.BALL_LEFT_FIELD_TOUCH_LINE, story.us)
    assert story.game.restart_team is story.them


def test_the_second_touch_can_be_allowed(us: Team) -> None:
    story = throw_in(Story(us, OPEN.model_copy(update={"double_touch": False})).tick())
    story.touch(1).roll(0.5, 2.0).roll(0.4, 2.0)
    story.ours(1, 0.4 - ROBOT_RADIUS - BALL_RADIUS, 2.0, heading=3.0).tick()
    assert EventKind.ATTACKER_DOUBLE_TOUCHED_BALL not in story.kinds


# Kick-off.


def test_a_match_begins_with_the_kick_off_of_the_first_team(us: Team) -> None:
    story = Story(us, KICKOFF).theirs(0, 4.4, 0.0).tick()
    kickoff = (
        RefereeCommand.PREPARE_KICKOFF_BLUE if us is Team.BLUE else RefereeCommand.PREPARE_KICKOFF_YELLOW
    )
    assert story.game.command is kickoff
    assert story.game.stage is Stage.NORMAL_FIRST_HALF_PRE
    assert not story.game.may_touch
    story.wait(0.1)
    assert story.game.command is RefereeCommand.NORMAL_START
    assert story.game.stage is Stage.NORMAL_FIRST_HALF
    assert story.game.may_touch
    assert not story.game.in_play


@pytest.mark.parametrize(
    ("x", "y"), [(0.5, 1.0), (-0.3, 0.3)], ids=["in the other half", "in the centre circle"]
)
def test_a_kick_off_waits_for_opponents_out_of_place(us: Team, x: float, y: float) -> None:
    story = Story(us, KICKOFF).theirs(2, -x, -y).tick()
    story.opponents[2] = RobotState(2, x if x < 0 else -x, y)
    story.wait(3.0)
    assert not story.game.may_touch
    story.wait(2.5)
    assert story.game.may_touch


def test_one_kicker_may_wait_in_the_centre_circle(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, -0.2, 0.0).ours(2, -1.0, 1.0).tick().tick()
    assert story.game.may_touch


def test_a_second_robot_in_the_centre_circle_delays_the_kick_off(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, -0.2, 0.0).ours(2, -0.2, 0.4).tick().wait(1.0)
    assert not story.game.may_touch


def test_a_kick_off_waits_for_robots_to_stand(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, -2.0, 0.0, vx=1.0).tick().wait(1.0)
    assert not story.game.may_touch


def test_a_ball_moved_before_the_kick_off_is_put_back(us: Team) -> None:
    story = Story(us, KICKOFF).ours(2, -0.2, 0.4).ours(1, -0.2, 0.0).tick()
    story.touch(1).roll(0.2, 0.0, 1.0)
    story.wait(0.3)
    assert story.placed == (0.0, 0.0)


def test_a_goal_straight_from_the_kick_off_counts(us: Team) -> None:
    story = Story(us, KICKOFF).ours(1, -0.2, 0.0).tick().tick()
    assert story.game.may_touch
    story.touch(1).roll(1.0, 0.0, 6.0).roll(4.4, 0.0, 6.0).roll(4.53, 0.0, 6.0)
    assert story.score == (1, 0)


# Fouls in play.


def test_carrying_the_ball_more_than_a_metre_is_a_foul(story: Story) -> None:
    story.touch(1)
    for step in range(34):
        x = 0.03 * step
        story.ours(1, x - 0.097, 0.5, ball_contact=True).roll(x, 0.5)
    assert story.events == []
    story.ours(1, 1.02 - 0.097, 0.5, ball_contact=True).roll(1.02, 0.5)
    assert story.events == [(EventKind.BOT_DRIBBLED_BALL_TOO_FAR, story.us)]
    assert story.game.restart_team is story.them
    assert story.game.placement == approx((1.02, 0.5))


def test_letting_the_ball_go_on_the_way_starts_the_metre_anew(story: Story) -> None:
    story.touch(1)
    for step in range(60):
        x = 0.03 * step
        gap = 0.1 if step == 30 else 0.0
        story.ours(1, x - 0.097 - gap, 0.5, ball_contact=not gap).roll(x, 0.5)
    assert story.events == []


def test_a_short_gap_does_not_start_the_metre_anew(story: Story) -> None:
    story.touch(1)
    for step in range(60):
        x = 0.03 * step
        gap = 0.05 if step == 30 else 0.0
        story.ours(1, x - 0.097 - gap, 0.5, ball_contact=not gap).roll(x, 0.5)
    assert EventKind.BOT_DRIBBLED_BALL_TOO_FAR in story.kinds


def test_a_ball_kicked_too_fast_is_noted_once_and_play_goes_on(story: Story) -> None:
    story.touch(1).roll(0.1, 0.0, 6.6).roll(0.2, 0.0, 6.55).roll(0.3, 0.0, 6.4)
    assert story.events == [(EventKind.BOT_KICKED_BALL_TOO_FAST, story.us)]
    assert story.game.in_play


def test_the_speed_counts_in_every_direction(story: Story) -> None:
    assert story.touch(1).roll(0.1, 0.0, 4.0, -5.4).kinds == [EventKind.BOT_KICKED_BALL_TOO_FAST]


def test_a_kick_at_the_limit_is_fair(story: Story) -> None:
    assert story.touch(1).roll(0.1, 0.0, 3.9, 5.2).events == []


def test_a_defender_inside_its_own_area_with_the_ball_costs_a_penalty(story: Story) -> None:
    x = -GOAL_LINE + 0.5
    story.ours(3, x, 0.3).touch(3).roll(x + 0.098, 0.3)
    assert story.events == [(EventKind.DEFENDER_IN_DEFENSE_AREA, story.us)]
    assert (story.game.restart, story.game.restart_team) == (Restart.PENALTY, story.them)
    assert story.game.placement == approx((1.5, 0.0))


def test_a_defender_only_partly_inside_its_own_area_may_touch(story: Story) -> None:
    x = -GOAL_LINE + FIELD.defense_depth - ROBOT_RADIUS + 0.01
    story.ours(3, x, 0.3).touch(3).roll(x + 0.098, 0.3)
    assert story.events == []


def test_the_keeper_may_touch_in_its_own_area(story: Story) -> None:
    x = -GOAL_LINE + 0.5
    story.ours(0, x, 0.3).touch(0).roll(x + 0.098, 0.3)
    assert story.events == []


def test_the_keeper_is_the_robot_the_settings_name(us: Team) -> None:
    settings = OPEN.model_copy(update={f"{us.value}_keeper": 3, f"{us.other.value}_keeper": 4})
    story = Story(us, settings).tick()
    story.ours(3, -GOAL_LINE + 0.5, 0.3).touch(3).roll(-GOAL_LINE + 0.598, 0.3)
    assert story.events == []
    story.theirs(4, GOAL_LINE - 0.5, 0.3).touch(4, story.them).roll(GOAL_LINE - 0.402, 0.3)
    assert story.events == []
    story.ours(0, -GOAL_LINE + 0.5, -0.3).touch(0).roll(-GOAL_LINE + 0.598, -0.3)
    assert story.kinds == [EventKind.DEFENDER_IN_DEFENSE_AREA]


def test_an_attacker_that_touches_partly_inside_their_area_fouls_without_stopping_play(story: Story) -> None:
    x = GOAL_LINE - FIELD.defense_depth - ROBOT_RADIUS + 0.01
    story.ours(3, x, 0.3).touch(3).roll(x + 0.098, 0.3).tick()
    assert story.events == [(EventKind.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA, story.us)]
    assert story.game.in_play


def test_an_attacker_just_outside_their_area_may_touch(story: Story) -> None:
    x = GOAL_LINE - FIELD.defense_depth - ROBOT_RADIUS - 0.01
    assert story.ours(3, x, 0.3).touch(3).roll(x + 0.098, 0.3).events == []


def test_a_fast_robot_that_runs_into_a_slow_one_crashes(story: Story) -> None:
    story.ours(1, 0.0, 1.0, vx=1.6).theirs(1, 0.18, 1.0).tick().tick()
    assert story.events == [(EventKind.BOT_CRASH_UNIQUE, story.us)]
    assert story.game.in_play


def test_a_crash_counts_in_every_direction(story: Story) -> None:
    story.ours(1, 0.0, 1.0, vx=-0.2, vy=0.0).theirs(1, -0.12, 1.12, vx=1.2, vy=-1.2).tick()
    assert story.events == [(EventKind.BOT_CRASH_UNIQUE, story.them)]


def test_both_are_at_fault_when_they_meet_at_like_speeds(story: Story) -> None:
    story.ours(1, 0.0, 1.0, vx=1.0).theirs(1, 0.18, 1.0, vx=-0.9).tick()
    assert story.events == [(EventKind.BOT_CRASH_DRAWN, None)]


def test_a_crash_counts_at_the_speeds_before_it(story: Story) -> None:
    # From one frame to the next they have met and stopped each other.
    story.ours(1, 0.0, 1.0, vx=1.6).theirs(1, 0.21, 1.0).tick()
    assert story.events == []
    story.ours(1, 0.026, 1.0, vx=0.6).theirs(1, 0.21, 1.0, vx=0.5).tick()
    assert story.events == [(EventKind.BOT_CRASH_UNIQUE, story.us)]


@pytest.mark.parametrize(("vx", "vy"), [(1.4, 0.0), (0.0, 3.0)], ids=["slow", "passing"])
def test_a_slow_or_passing_contact_is_no_crash(story: Story, vx: float, vy: float) -> None:
    assert story.ours(1, 0.0, 1.0, vx=vx, vy=vy).theirs(1, 0.18, 1.0).tick().events == []


def test_a_ball_at_rest_is_started_anew_where_it_lies(story: Story) -> None:
    story.roll(1.0, 1.0).wait(9.9)
    assert story.events == []
    story.wait(0.2)
    assert story.events == [(EventKind.NO_PROGRESS_IN_GAME, None)]
    story.wait(1.0)
    assert story.game.command is RefereeCommand.FORCE_START
    assert story.placed is None


def test_a_ball_that_creeps_on_makes_progress(story: Story) -> None:
    for step in range(700):
        story.roll(0.001 * step, 1.0)
    assert story.events == []


def test_the_ball_may_not_stay_in_a_defence_area(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"keeper_hold_time": 3.0})).tick()
    story.wait(2.0).touch(0).roll(-4.0, 0.5).wait(2.9)
    assert story.events == []
    story.wait(0.2)
    assert story.events == [(EventKind.KEEPER_HELD_BALL, us)]
    assert story.game.restart_team is story.them
    assert story.game.placement == approx((-2.5, 0.5))


def test_checks_can_be_switched_off(us: Team) -> None:
    settings = RefereeSettings(
        opening="force_start", max_ball_speed=None, crash_speed=None, defense_areas=False, max_dribble=None
    )
    story = Story(us, settings).tick().ours(3, -4.0, 0.0, vx=3.0, ball_contact=True)
    story.theirs(1, -3.82, 0.0).touch(3).roll(-3.9, 0.0, 9.0)
    story.ours(3, 4.0, 0.0, ball_contact=True).roll(4.097, 0.0)
    assert story.events == []


def test_a_new_crash_is_noted_after_a_restart(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"stop_time": 0.0, "kick_timeout": 0.5})).tick()
    story.ours(1, 0.0, 1.0, vx=1.6).theirs(1, 0.18, 1.0).tick()
    story.touch(3).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(2.0)
    assert story.game.in_play
    assert story.events.count((EventKind.BOT_CRASH_UNIQUE, us)) == 2


# STOP.


def test_fast_robots_in_stop_are_noted_after_the_grace_time(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"stop_time": 4.0})).tick().ours(1, 0.0, 0.0, vx=1.6)
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(1.9)
    assert EventKind.BOT_TOO_FAST_IN_STOP not in story.kinds
    story.wait(0.5)
    assert story.events.count((EventKind.BOT_TOO_FAST_IN_STOP, us)) == 1


def test_robots_at_the_speed_allowed_in_stop_are_not_noted(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"stop_time": 4.0})).tick().ours(1, 0.0, 0.0, vx=1.5)
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(3.0)
    assert EventKind.BOT_TOO_FAST_IN_STOP not in story.kinds


def test_the_limits_of_a_stop_can_be_switched_off(us: Team) -> None:
    free = {"stop_time": 4.0, "stop_speed": None, "stop_distance": None}
    story = Story(us, OPEN.model_copy(update=free)).tick().ours(1, 1.0, SPOT[1] - 0.2, vx=3.0)
    story.touch(3, story.them).roll(1.0, TOUCH_LINE - 0.01).roll(1.0, TOUCH_LINE + 0.05).wait(8.0)
    assert story.kinds == [EventKind.BALL_LEFT_FIELD_TOUCH_LINE]


def test_opponents_too_near_a_free_kick_are_noted_and_the_kickers_team_is_not(story: Story) -> None:
    throw_in(story).ours(1, 1.0, SPOT[1] - 0.2).theirs(2, 1.0, SPOT[1] - 0.5).wait(1.5)
    assert EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT not in story.kinds
    story.wait(1.0)
    assert story.kinds.count(EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT) == 1
    assert story.events[-1] == (EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT, story.them)


# Penalty kicks and halves.


def test_a_penalty_starts_when_everybody_is_in_place(us: Team) -> None:
    story = Story(us, OPEN.model_copy(update={"kickoff_wait": 60.0})).tick()
    story.ours(3, -4.0, 0.3).touch(3).roll(-3.902, 0.3)
    story.theirs(1, 2.0, 0.0).theirs(2, 1.0, 1.0).ours(0, -3.0, 0.0).ours(3, 2.0, 1.0).wait(2.0)
    prepare = (
        RefereeCommand.PREPARE_PENALTY_YELLOW if us is Team.BLUE else RefereeCommand.PREPARE_PENALTY_BLUE
    )
    assert story.game.command is prepare
    assert story.placed == approx((1.5, 0.0))
    story.theirs(2, 2.6, 1.0).ours(3, 2.6, 0.5).wait(0.1)
    assert story.game.command is prepare
    story.ours(0, -GOAL_LINE + 0.05, 0.0).wait(0.1)
    assert story.game.command is RefereeCommand.NORMAL_START
    assert story.game.restart is Restart.PENALTY
    story.touch(1, story.them).roll(1.0, 0.0, -5.0)
    assert story.game.in_play


def test_the_other_team_kicks_off_the_second_half_and_the_match_ends(us: Team) -> None:
    settings = RefereeSettings(half_length=5.0, half_time=1.0, no_progress_time=None, kick_timeout=0.5)
    story = Story(us, settings).tick().wait(5.1)
    assert (story.game.command, story.game.stage) == (RefereeCommand.HALT, Stage.NORMAL_HALF_TIME)
    story.wait(1.1)
    assert story.game.stage is Stage.NORMAL_SECOND_HALF_PRE
    assert story.game.restart_team is story.them
    story.wait(1.0)
    assert story.game.stage is Stage.NORMAL_SECOND_HALF
    story.wait(5.0)
    assert (story.game.command, story.game.stage) == (RefereeCommand.HALT, Stage.POST_GAME)
    story.wait(1.0)
    assert story.game.halted


def test_a_goal_at_the_end_of_a_half_still_counts(us: Team) -> None:
    settings = OPEN.model_copy(update={"half_length": 1.0})
    story = Story(us, settings).tick().touch(1).roll(4.4, 0.0).wait(0.94).roll(GOAL_LINE + 0.05, 0.0)
    story.wait(0.1)
    assert story.score == (1, 0)
    assert story.game.stage is not Stage.NORMAL_HALF_TIME
    late = Story(us, OPEN.model_copy(update={"half_length": 1.0})).tick().touch(1).roll(4.4, 0.0)
    late.time = 1.0
    late.roll(GOAL_LINE + 0.05, 0.0)
    assert late.score == (1, 0)
    assert late.game.stage is Stage.NORMAL_HALF_TIME


def test_the_same_frames_give_the_same_decisions(us: Team) -> None:
    def tell() -> tuple[list[tuple[EventKind, Team | None]], GameState]:
        story = throw_in(Story(us).tick()).touch(1).roll(0.5, 2.0).roll(-GOAL_LINE - 0.03, 0.0).wait(3.0)
        return story.events, story.referee.game

    assert tell() == tell()


def test_a_frame_from_yellows_side_is_refused() -> None:
    view = Frame(0.0, FIELD, BallState(0.0, 0.0), team=Team.YELLOW)
    with pytest.raises(ValueError, match="blue's side"):
        Referee(FIELD).update(view)


# Contact.


def test_where_the_world_says_nothing_contact_tells_who_touched_last(us: Team) -> None:
    story = Story(us).tick().ours(4, 1.0, TOUCH_LINE - 0.1 - 0.11, heading=-1.5708)
    story.roll(1.0, TOUCH_LINE - 0.1).roll(1.0, TOUCH_LINE + 0.05)
    assert story.events == [(EventKind.BALL_LEFT_FIELD_TOUCH_LINE, us)]
