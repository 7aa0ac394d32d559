import numpy as np
import pytest

from paper.goalkeeper_fit import START, chances
from paper.goalkeeper_race import race_inputs
from robobt.shots.data import goals, read_shots
from robobt.shots.keepers.population import REAL, read_population
from robobt.shots.predict.validation import judge
from tests.shots.made_up import made_up_table
from tests.shots.real_data import REAL_SHOTS, needs_real_shots

POPULATION = read_population(REAL)


def shot(across: float, target: float = -0.3, vy: float = 0.0, ball: tuple[float, float] = (1.5, -0.3)):
    """A shot along the field, the goalkeeper beside its line."""
    return np.array([[*ball, target, 4.2, ball[1] + across, 0.0, vy, 0.0]])


def chance(row: np.ndarray, **changes: float) -> float:
    return float(chances(POPULATION.model_copy(update=changes), row)[0])


def test_a_goalkeeper_on_the_line_saves_and_one_far_off_does_not():
    assert chance(shot(0.0)) < 0.01
    assert chance(shot(0.9)) > 0.95


def test_the_farther_off_the_likelier_a_goal():
    likely = [chance(shot(across)) for across in np.linspace(0.1, 0.8, 12)]
    assert likely == sorted(likely)


def test_one_that_is_on_its_way_saves_more_and_one_that_goes_away_less():
    at_rest = chance(shot(0.35))
    assert chance(shot(0.35, vy=-0.7)) < at_rest < chance(shot(0.35, vy=0.7))


@pytest.mark.parametrize(
    "changes", [{"max_speed": 0.5}, {"acceleration": 1.5}, {"braking": 0.4}, {"delay": 0.2}]
)
def test_a_weaker_goalkeeper_saves_less(changes: dict[str, float]):
    assert chance(shot(0.33), **changes) > chance(shot(0.33)) + 0.1


def test_a_shot_past_the_post_is_no_goal():
    assert chance(shot(1.2, target=-0.55)) < 0.25
    assert chance(shot(0.9, target=-0.55), kick_error=0.0) == 0.0


def test_a_ball_off_the_aim_takes_the_kick_with_it():
    astray = shot(0.35)
    astray[0, 7] = 0.1
    assert chance(astray) < chance(shot(0.35))


def test_a_scene_and_its_mirror_image_have_the_same_chance():
    scene = np.array([[1.4, -0.8, 0.2, 4.1, -0.2, 0.05, 0.4, 0.03]])
    mirrored = scene * [1, -1, -1, 1, -1, 1, -1, -1]
    still = {"kick_error": 0.0}
    assert chance(scene, **still) == pytest.approx(chance(mirrored, **still), abs=1e-9)


def test_rows_are_where_the_table_says_they_are():
    table = made_up_table(40)
    rows = race_inputs(table)
    for i, name in enumerate(("ball_x", "ball_y", "target_y", "opp_x_global", "opp_y_global")):
        np.testing.assert_allclose(rows[:, i], table.column(name).to_numpy(), atol=1e-9)
    vx = [entry[0] for entry in table.column("opponents_vx").to_pylist()]
    np.testing.assert_allclose(rows[:, 5], vx, atol=1e-9)


@needs_real_shots
def test_the_fitted_goalkeepers_explain_the_real_shots_and_the_papers_pilot_alone_does_not():
    table = read_shots(REAL_SHOTS / "train.csv")
    shots, scored = race_inputs(table), goals(table)
    fitted, assumed = (judge(chances(who, shots), scored) for who in (POPULATION, START))
    assert fitted.calibration_error < 0.05
    assert fitted.log_loss < 0.23 < assumed.log_loss
    assert abs(chances(POPULATION, shots).mean() - scored.mean()) < 0.03
