"""What every shot rater keeps to."""

from math import hypot, pi

import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from robobt.skills.aim.raters import RATERS, NNFiltered, SegmentClearance, ShotRater, make_rater
from robobt.skills.store import Shot
from robobt.testing import Trial, blue, eventually, frame, goal_for, robot, yellow
from robobt.world import DIVISION_A, DIVISION_B, BallState, FieldGeometry, Frame, RobotState, Team
from robobt.world.geometry import Point

NAMES = sorted(RATERS)
BOLD: dict[str, ShotRater] = {"nn_filtered": NNFiltered(threshold=0.05, tolerance=0.2)}
"""With other settings, raters that by default would rather not shoot at all past a robot that is near."""
each_rater = pytest.mark.parametrize("name", NAMES)


def wall(x: float, half: float = 0.9) -> tuple[RobotState, ...]:
    """Opponents side by side across the x axis."""
    count = int(2 * half / 0.18) + 1
    return tuple(robot(x, -half + i * 0.18, number=i) for i in range(count))


def rated(
    name: str, origin: Point, opponents: tuple[RobotState, ...] = (), heading: float = 0.0, delay: float = 0.0
) -> list[Shot]:
    return rated_by(make_rater(name), origin, opponents, heading, delay)


def rated_by(
    rater: ShotRater,
    origin: Point,
    opponents: tuple[RobotState, ...] = (),
    heading: float = 0.0,
    delay: float = 0.0,
) -> list[Shot]:
    me = robot(origin[0] - 0.1, origin[1], heading)
    return rater.rate_all(frame(me, origin, opponents=opponents), origin, me, delay=delay)


def bold(name: str) -> ShotRater:
    return BOLD.get(name) or make_rater(name)


def test_the_four_baselines_go_by_name() -> None:
    assert {"segment_clearance", "open_angle", "moving_horizon", "gaussian"} <= set(NAMES)


@each_rater
def test_an_unguarded_goal_is_a_good_shot_at_its_middle(name: str) -> None:
    (shot,) = rated(name, (1.5, 0.0))
    assert shot.target[0] == DIVISION_B.half_length
    assert abs(shot.target[1]) < 0.02
    assert shot.score > 0.9
    assert 0.0 < shot.tolerance < 0.2


@each_rater
def test_behind_a_wall_there_is_no_shot(name: str) -> None:
    assert all(shot.score < 0.05 for shot in rated(name, (1.5, 0.0), wall(2.5)))


@each_rater
def test_a_robot_behind_the_ball_does_not_block(name: str) -> None:
    open_goal = rated(name, (1.5, 0.5))
    for gap in (0.3, 0.6, 2.0):
        assert rated(name, (1.5, 0.5), (robot(1.5 - gap, 0.5),)) == open_goal


@pytest.mark.parametrize("name", ["open_angle", "gaussian"])
def test_a_robot_in_the_goal_behind_its_line_does_not_block_the_way_to_the_line(name: str) -> None:
    assert rated(name, (1.5, 0.0), (robot(4.75, 0.0),)) == rated(name, (1.5, 0.0))


@each_rater
def test_the_shooter_does_not_block_itself_and_team_mates_do(name: str) -> None:
    me = robot(2.4, 0.0, number=3)
    mate = robot(3.2, 0.05, number=4)
    rater = make_rater(name)
    alone = rater.rate(frame(me, (1.5, 0.0)), (1.5, 0.0), me)
    with_mate = rater.rate(frame(me, (1.5, 0.0), mates=(mate,)), (1.5, 0.0), me)
    assert alone is not None
    assert alone.score > 0.9
    assert with_mate is not None or name in BOLD
    assert with_mate is None or with_mate.score < alone.score


@each_rater
@pytest.mark.parametrize("x", [4.5, 4.7])
def test_from_the_goal_line_on_there_is_no_shot(name: str, x: float) -> None:
    assert rated(name, (x, 0.2)) == []
    assert make_rater(name).rate(frame(robot(), (x, 0.2)), (x, 0.2), robot()) is None


@each_rater
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_of_two_equal_openings_the_one_faced_comes_first(name: str, side: float) -> None:
    shots = rated_by(bold(name), (2.0, 0.0), (robot(4.0, 0.0, pi),), heading=side * 0.3)
    assert len(shots) == 2
    assert shots[0].score == pytest.approx(shots[1].score)
    assert shots[0].target[1] * side > 0.0


@each_rater
def test_openings_come_best_first(name: str) -> None:
    shots = rated_by(bold(name), (2.0, 0.0), (robot(4.0, 0.08, pi),))
    assert len(shots) == 2
    assert shots[0].score > shots[1].score
    assert shots[0].target[1] < 0.0 < shots[1].target[1]


@each_rater
def test_a_goalkeeper_nearer_to_one_post_leaves_the_other_side(name: str) -> None:
    shot = rated(name, (2.0, 0.0), (robot(4.3, 0.25, pi),))[0]
    assert shot.target[1] < -0.1


@each_rater
def test_the_goal_is_that_of_the_field_played_on(name: str) -> None:
    me = robot(2.9, 0.0)
    scene = frame(me, (3.0, 0.0), field=DIVISION_A)
    shot = make_rater(name).rate(scene, (3.0, 0.0), me)
    assert shot is not None
    assert shot.target == pytest.approx((6.0, 0.0), abs=0.02)


@pytest.mark.integration
@each_rater
@pytest.mark.parametrize("ball", [(2.0, 0.0), (3.0, 1.2), (2.4, -1.0)])
@pytest.mark.parametrize("keeper", [-0.25, 0.0, 0.3])
def test_a_ball_kicked_at_the_target_past_a_keeper_at_rest_is_a_goal(
    name: str, ball: tuple[float, float], keeper: float
) -> None:
    poses = {blue(1): (ball[0] - 0.3, ball[1], 0.0), yellow(0): (4.2, keeper, pi)}
    scene = Trial({}, poses, ball).world.observe()
    me = scene.own[0]
    shot = make_rater(name).rate(scene, ball, me) or bold(name).rate(scene, ball, me)
    assert shot is not None
    dx, dy = shot.target[0] - ball[0], shot.target[1] - ball[1]
    way = hypot(dx, dy)
    trial = Trial({}, poses, (*ball, 6.0 * dx / way, 6.0 * dy / way))
    trial.run(2.0, eventually("the ball is in the goal", goal_for(Team.BLUE)))


def test_the_learned_veto_lets_fewer_shots_pass_the_likelier_they_are_to_fail() -> None:
    rater = NNFiltered(model="shot_nn_strong")
    spared = rated_by(rater, (2.0, 0.0), (robot(4.3, 0.3, pi),))
    assert spared
    # In the middle the goalkeeper reaches either side.
    assert rated_by(rater, (2.0, 0.0), (robot(4.0, 0.0, pi),)) == []


# The properties below hold for any scene.

metres = st.floats(-4.5, 4.5)
speeds = st.floats(-2.0, 2.0)
robots = st.builds(
    lambda x, y, vx, vy: RobotState(0, x, y * 2 / 3, 0.0, vx, vy), metres, metres, speeds, speeds
)
origins = st.tuples(st.floats(-4.0, 4.3), st.floats(-2.9, 2.9))


def scene(origin: Point, heading: float, others: list[RobotState], mate: RobotState | None = None) -> Frame:
    opponents = []
    for number, other in enumerate(others):
        opponents.append(RobotState(number, other.x, other.y, other.heading, other.vx, other.vy))
    own = [RobotState(0, origin[0] - 0.1, origin[1], heading)]
    if mate is not None:
        own.append(RobotState(1, mate.x, mate.y, mate.heading, mate.vx, mate.vy))
    return Frame(0.0, DIVISION_B, BallState(*origin), tuple(own), tuple(opponents))


def reflected(robots: tuple[RobotState, ...]) -> tuple[RobotState, ...]:
    return tuple(RobotState(r.id, r.x, -r.y, -r.heading, r.vx, -r.vy, -r.omega) for r in robots)


@pytest.mark.integration
@each_rater
@settings(max_examples=30)
@given(
    origin=origins,
    heading=st.floats(-3.0, 3.0),
    others=st.lists(robots, max_size=5),
    delay=st.floats(0, 1),
)
@example(origin=(0.0, 0.15625), heading=0.0, others=[RobotState(0, 0.0, 0.0, 0.0)], delay=0.0)
def test_a_mirrored_scene_has_the_mirrored_shot(
    name: str, origin: Point, heading: float, others: list[RobotState], delay: float
) -> None:
    rater = make_rater(name)
    here = scene(origin, heading, others)
    there = Frame(
        0.0,
        DIVISION_B,
        BallState(origin[0], -origin[1]),
        reflected(here.own),
        reflected(here.opponents),
    )
    shots = rater.rate_all(here, here.ball.position, here.own[0], delay=delay)
    mirrored = rater.rate_all(there, there.ball.position, there.own[0], delay=delay)
    assert [shot.score for shot in mirrored] == pytest.approx([shot.score for shot in shots], abs=1e-5)
    assume(shots and (len(shots) == 1 or shots[0].score - shots[1].score > 1e-5))
    # A Gaussian's flat top is aimed at to within a step of its grid.
    within = 0.021 if name == "gaussian" else 1e-7
    here_aim, there_aim = shots[0].target[1], -mirrored[0].target[1]
    if abs(here_aim - there_aim) > within:
        # Of two summits that are as good, either may be aimed at.
        _, line = rater.judge(here, here.ball.position, here.own[0], delay=delay)
        assert line is not None
        as_good = np.interp([here_aim, there_aim], line[0][:, 1], line[1])
        assert as_good[0] == pytest.approx(as_good[1], abs=1e-3)


@pytest.mark.integration
@each_rater
@settings(max_examples=30)
@given(origin=origins, others=st.lists(robots, max_size=4), more=robots, is_mate=st.booleans())
def test_one_robot_more_never_improves_the_best_score(
    name: str, origin: Point, others: list[RobotState], more: RobotState, is_mate: bool
) -> None:
    rater = make_rater(name)
    before = scene(origin, 0.0, others)
    after = scene(origin, 0.0, others, mate=more) if is_mate else scene(origin, 0.0, [*others, more])
    first, second = (rater.rate(each, origin, each.own[0]) for each in (before, after))
    if second is not None:
        assert first is not None
        assert second.score <= first.score + 1e-9


@pytest.mark.integration
@each_rater
@settings(max_examples=30)
@given(origin=origins, others=st.lists(robots, max_size=6))
def test_shots_are_at_the_goal_and_scores_are_shares(
    name: str, origin: Point, others: list[RobotState]
) -> None:
    here = scene(origin, 0.0, others)
    shots = make_rater(name).rate_all(here, origin, here.own[0])
    for shot in shots:
        assert shot.target[0] == DIVISION_B.half_length
        assert abs(shot.target[1]) < DIVISION_B.goal_width / 2
        assert 0.0 <= shot.score <= 1.0
        assert shot.tolerance > 0.0
    assert [s.score for s in shots] == pytest.approx(sorted((s.score for s in shots), reverse=True))


def test_a_rater_is_made_by_name_with_its_settings() -> None:
    named = make_rater({"name": "segment_clearance", "tolerance": 0.3645})
    assert named == SegmentClearance(tolerance=0.3645)
    assert make_rater({"name": "segment_clearance"}) == make_rater("segment_clearance") == SegmentClearance()


def test_a_rater_of_ones_own_needs_only_rate_all() -> None:
    class Centre(ShotRater):
        def rate_all(self, frame: Frame, origin: Point, me: RobotState, *, delay: float = 0.0) -> list[Shot]:
            return [Shot(frame.field.their_goal, 0.1, 0.5)]

    field = FieldGeometry(length=6, width=4, goal_width=0.7, defense_width=1.5, defense_depth=0.7)
    me = robot()
    assert Centre().rate(frame(me, field=field), (0, 0), me) == Shot((3.0, 0.0), 0.1, 0.5)
