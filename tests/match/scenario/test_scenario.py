import json
import pickle
import re
from itertools import combinations
from math import atan2, hypot, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import BaseModel

from robobt.config.resources import bundled_scenarios
from robobt.config.yaml import parse_marked, write_yaml
from robobt.match import ScenarioError, load_scenario
from robobt.match.scenario.placing import HELD_DISTANCE
from robobt.match.scenario.robots import RobotSetup
from robobt.match.scenario.scenario import Ends, Scenario, scenario_from
from robobt.match.scenario.starts import Around, BallStart, Box, Disc, RobotStart
from robobt.world import BALL_RADIUS, ROBOT_RADIUS, RobotId, RobotLimits, Team
from tests.match.scripted import data

BLUE_0, YELLOW_0 = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)


def rng(seed: int = 0) -> np.random.Generator:
    return np.random.default_rng(seed)


def robot(number: int = 0, **changes: Any) -> dict[str, Any]:
    setup = {"number": number, "play": "scripted", "start": {"position": [-2.0, 0.0]}}
    return {**setup, **changes}


def scenario(**changes: Any) -> Scenario:
    return scenario_from(data(**changes), "test.yaml")


def problem(**changes: Any) -> str:
    """What a scenario with these changes is refused for."""
    with pytest.raises(ScenarioError) as caught:
        scenario(**changes)
    message = str(caught.value)
    assert "\n" not in message
    return message


def file_problem(path: Path, content: str | bytes) -> str:
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(str(path))
    return message.removeprefix(str(path)).removeprefix(": ")


class TestFiles:
    def test_a_file_is_loaded_and_called_after_itself_when_it_has_no_name(self, tmp_path: Path):
        path = tmp_path / "one_on_none.yaml"
        path.write_text(write_yaml({key: value for key, value in data().items() if key != "name"}))
        assert load_scenario(path).name == "one_on_none"
        assert load_scenario(str(path)).robots.blue[0].play == "scripted"

    def test_a_name_is_looked_up_among_the_bundled_ones(self):
        assert load_scenario("striker_vs_goalkeeper").name == "striker_vs_goalkeeper"

    @pytest.mark.parametrize("name", bundled_scenarios())
    def test_every_bundled_scenario_loads_and_can_be_placed(self, name: str):
        loaded = load_scenario(name)
        assert loaded.description
        assert loaded.name == name
        for seed in range(20):
            loaded.place(rng(seed))

    def test_no_such_file_lists_the_bundled_scenarios(self):
        with pytest.raises(ScenarioError, match=r"nowhere: no such file or bundled .*striker_vs_goalkeeper"):
            load_scenario("nowhere")

    def test_a_folder_is_no_scenario(self, tmp_path: Path):
        with pytest.raises(ScenarioError, match="cannot be read"):
            load_scenario(tmp_path)

    def test_bad_yaml_names_the_line(self, tmp_path: Path):
        assert file_problem(tmp_path / "s.yaml", "name: a\nrobots: [\nends: }").startswith(":3: ")

    @pytest.mark.parametrize(
        ("content", "expected"),
        [
            ("name: !mine x", ":1: the tag !mine is not allowed"),
            ("- 1\n- 2", "must hold a mapping of fields"),
            ("", "must hold a mapping of fields"),
            ("name: a\x00b", "is not text"),
        ],
        ids=lambda value: str(value)[:20],
    )
    def test_what_is_no_plain_yaml_is_one_error(self, tmp_path: Path, content: str | bytes, expected: str):
        assert file_problem(tmp_path / "s.yaml", content).startswith(expected)

    def test_numbers_may_be_written_with_an_exponent(self, tmp_path: Path):
        path = tmp_path / "s.yaml"
        path.write_text(write_yaml(data()).replace("period: 0.02", "period: 2e-2"))
        assert load_scenario(path).period == 0.02


class TestFields:
    def test_a_preset_and_dimensions_are_both_fields(self):
        assert scenario(field="division_a").field.length == 12.0
        inline = {"length": 6.0, "width": 4.0, "goal_width": 0.8, "defense_width": 1.6, "defense_depth": 0.8}
        assert scenario(field=inline).field.width == 4.0

    def test_a_simulator_is_a_preset_or_settings(self):
        assert scenario(simulator="grsim").simulator == {"preset": "grsim"}
        assert scenario(simulator={"kicker": {"max_speed": 3}}).simulator == {"kicker": {"max_speed": 3}}

    def test_a_referee_is_on_off_or_has_settings(self):
        assert scenario(referee=False).referee is None
        assert scenario(referee=True).referee is not None
        settings = scenario(referee={"max_dribble": None}).referee
        assert settings is not None
        assert settings.max_dribble is None

    def test_prediction_is_on_off_or_measured(self):
        assert scenario(predict="measured").predict == "measured"
        assert scenario(predict=False).predict is False
        for wrong in ("Measured", 1, None, ["measured"], {"measured": True}):
            assert "predict: takes true, false or measured, not " in problem(predict=wrong)

    def test_limits_change_only_what_they_name(self):
        loaded = scenario(robots={"blue": [robot(limits={"max_speed": 1.0})]})
        limits = loaded.robots.blue[0].limits_over(RobotLimits(max_speed=4.0, acceleration=2.0))
        assert (limits.max_speed, limits.acceleration) == (1.0, 2.0)

    def test_it_survives_its_own_json(self):
        referee = {"opening": "free_kick", "opening_spot": [1, -2.5]}
        loaded = scenario(ball={"position": {"center": [0, 0], "radius": 1}}, referee=referee)
        assert loaded.referee is not None
        assert loaded.referee.opening_spot == (1.0, -2.5)
        again = scenario_from(json.loads(loaded.model_dump_json()), "again")
        assert again.model_dump() == loaded.model_dump()

    @pytest.mark.parametrize(
        ("changes", "expected"),
        [
            (
                {"robots": {"blue": [robot(play="x")]}},
                "robots.blue.0.play: no play is called 'x'; 'robobt list plays' lists all",
            ),
            ({"robots": {"blue": [robot(number=-1)]}}, "robots.blue.0.number: input should be greater"),
            ({"robots": {"blue": [robot(), robot()]}}, "robots.blue.1.number: blue has two robots 0"),
            ({"robots": {}}, "robots: there is no robot"),
            (
                {"robots": {"green": [robot()]}},
                "robots.green: there is no such field; there are blue, yellow",
            ),
            (
                {"robots": {"blue": [robot(i) for i in range(12)]}},
                "robots.blue: list should have at most 11 items, not 12",
            ),
            ({"robots": {"blue": "all"}}, "robots.blue: input should be a list"),
            (
                {"robots": {"blue": [robot(colour=1)]}},
                "robots.blue.0.colour: there is no such field; there are",
            ),
            ({"period": 1e-9}, "period: input should be greater than or equal to 0.005, not 1e-09"),
            ({"trials": 10**9}, "trials: input should be less than or equal to 100000"),
            ({"ends": {"time_limit": 1e12}}, "ends.time_limit: input should be less"),
            ({"ends": {}}, "ends.time_limit: is missing"),
            ({"ends": {"time_limit": 1, "score_limit": 3}}, "ends.score_limit: needs the referee"),
            ({"field": "division_c"}, "field: no field is called 'division_c'; there are division_a"),
            ({"field": {"length": 9}}, "field.width: is missing (and "),
            ({"name": "a\nb"}, "name: a name has to be printable"),
            ({"unknown": 1}, "unknown: there is no such field; there are name, description, field"),
            (
                {"referee": {"max_dribbel": 1}},
                "referee.max_dribbel: there is no such field; did you mean max_dribble?",
            ),
            ({"referee": "on"}, "referee: input should be"),
            ({"referee": {"opening_spot": [50, 0]}}, "referee.opening_spot: (50, 0) lies outside the field"),
            (
                {"robots": {"blue": [robot(), robot(1)]}, "referee": {"max_robots": 1}},
                "referee.max_robots: is 1, but blue has 2 robots",
            ),
            ({"referee": {"opening": "penalty"}}, "referee.opening: waits for yellow's goalkeeper, which is"),
            (
                {"referee": {"opening": "shoot_out"}, "robots": {"yellow": [robot()]}},
                "referee.opening: waits for blue's goalkeeper, which is not there; give one",
            ),
            ({"referee": {"shoot_out": True}}, "referee.shoot_out: waits for yellow's goalkeeper"),
        ],
        ids=lambda value: str(value)[:40],
    )
    def test_what_is_wrong_is_said_with_its_field(self, changes: dict[str, Any], expected: str):
        assert problem(**changes).removeprefix("test.yaml: ").startswith(expected)

    @pytest.mark.parametrize(
        ("params", "expected"),
        [
            ({"sped": 1}, "params.sped: scripted has no such parameter; it has speed, kick, breaks, corner"),
            ({"speed": True}, "params.speed: input should be a valid number, not True"),
            ({"corner": [1]}, "params.corner.1: field required, not [1]"),
            ({"corner": [1, "b"]}, "params.corner.1: input should be a valid number, not 'b'"),
            ({"speed": -1}, "params.speed: speed must not be negative"),
            ([], "params: input should be a mapping"),
        ],
        ids=str,
    )
    def test_parameters_of_plays_are_checked_against_their_signature(self, params: Any, expected: str):
        message = problem(robots={"blue": [robot(params=params)]})
        assert message.startswith(f"test.yaml: robots.blue.0.{expected}")

    def test_a_list_fits_a_point_and_an_integer_a_number(self):
        loaded = scenario(robots={"blue": [robot(params={"corner": [1, 2], "speed": 2})]})
        assert loaded.robots.blue[0].build_tree() is not loaded.robots.blue[0].build_tree()

    def test_the_error_can_be_sent_between_processes(self):
        error = ScenarioError("a.yaml", "is wrong", "robots.blue.0")
        copy = pickle.loads(pickle.dumps(error))
        assert (str(copy), copy.file, copy.field) == (str(error), "a.yaml", "robots.blue.0")


class TestStarts:
    def test_each_team_sees_itself_defending_minus_x(self):
        both = {"position": [-3.0, 1.0], "heading": 0.5}
        placement = scenario(robots={"blue": [robot(start=both)], "yellow": [robot(start=both)]}).place(rng())
        assert placement.robots[BLUE_0] == pytest.approx((-3.0, 1.0, 0.5))
        assert placement.robots[YELLOW_0] == pytest.approx((3.0, -1.0, 0.5 - pi))

    def test_the_same_numbers_place_everything_alike(self):
        start = {"position": {"x": [-4, -1], "y": [-2, 2]}, "heading": [-1, 1]}
        loaded = scenario(robots={"blue": [robot(start=start)]})
        assert loaded.place(rng(5)) == loaded.place(rng(5))
        assert loaded.place(rng(5)) != loaded.place(rng(6))

    def test_a_box_and_a_disc_hold_what_is_sampled_from_them(self):
        box = {"position": {"x": [-4, -3], "y": [1, 2]}}
        disc = {"position": {"center": [-1, -1], "radius": 0.5}}
        loaded = scenario(robots={"blue": [robot(start=box), robot(1, start=disc)]})
        for seed in range(50):
            robots = loaded.place(rng(seed)).robots
            x, y, _ = robots[BLUE_0]
            assert -4 <= x <= -3
            assert 1 <= y <= 2
            x, y, _ = robots[RobotId(Team.BLUE, 1)]
            assert hypot(x + 1, y + 1) <= 0.5

    @pytest.mark.parametrize(
        ("around", "middle"), [("ball", (0.5, 0.5)), ("own goal", (4.5, 0.0)), ("their goal", (-4.5, 0.0))]
    )
    def test_around_keeps_distance_and_bearing_in_the_own_view(
        self, around: str, middle: tuple[float, float]
    ):
        # In the view of yellow, whose own goal lies at the world's +x; bearing 0 is the world's -x.
        bearing = [-0.3, 0.3] if around != "their goal" else [pi - 0.3, pi + 0.3]
        start = {"position": {"around": around, "distance": [0.5, 0.8], "bearing": bearing}}
        loaded = scenario(robots={"yellow": [robot(start=start)]}, ball={"position": [0.5, 0.5]})
        for seed in range(50):
            x, y, _ = loaded.place(rng(seed)).robots[YELLOW_0]
            dx, dy = -(x - middle[0]), -(y - middle[1])
            if around == "their goal":
                dx, dy = -dx, -dy
            assert 0.5 <= hypot(dx, dy) <= 0.8
            assert abs(atan2(dy, dx)) <= 0.3 + 1e-9

    def test_headings_towards_ball_and_goal(self):
        loaded = scenario(
            robots={
                "blue": [robot(start={"position": [-2, -1], "heading": "towards goal"})],
                "yellow": [robot(start={"position": [-2, -1], "heading": "towards ball"})],
            },
            ball={"position": [1.0, 1.0]},
        )
        robots = loaded.place(rng()).robots
        assert robots[BLUE_0][2] == pytest.approx(atan2(1.0, 6.5))
        assert robots[YELLOW_0][2] == pytest.approx(atan2(0.0, -1.0))

    def test_a_held_ball_lies_in_the_mouth(self):
        start = {"position": {"x": [-4, -1], "y": [-2, 2]}, "heading": [-3, 3]}
        loaded = scenario(robots={"yellow": [robot(start=start)]}, ball={"held_by": "yellow 0"})
        for seed in range(20):
            placement = loaded.place(rng(seed))
            x, y, heading = placement.robots[YELLOW_0]
            dx, dy = placement.ball[0] - x, placement.ball[1] - y
            assert hypot(dx, dy) == pytest.approx(HELD_DISTANCE)
            assert atan2(dy, dx) == pytest.approx(heading)

    def test_random_starts_keep_their_distance(self):
        box = {"position": {"x": [-1.2, 1.2], "y": [-1.2, 1.2]}}
        loaded = scenario(
            robots={
                "blue": [robot(i, start=box) for i in range(6)],
                "yellow": [robot(i, start=box) for i in range(6)],
            },
            ball={"position": box["position"]},
            clearance=0.1,
        )
        for seed in range(20):
            placement = loaded.place(rng(seed))
            for a, b in combinations(placement.robots.values(), 2):
                assert hypot(a[0] - b[0], a[1] - b[1]) >= 2 * ROBOT_RADIUS + 0.1
            for x, y, _ in placement.robots.values():
                assert hypot(x - placement.ball[0], y - placement.ball[1]) >= ROBOT_RADIUS + BALL_RADIUS + 0.1

    def test_every_start_can_be_printed(self):
        start = {
            "position": {"around": "ball", "distance": [0.5, 1], "bearing": [0, 1]},
            "heading": "towards ball",
        }
        loaded = scenario(
            robots={"blue": [robot(start=start)]}, ball={"position": {"x": [0, 1], "y": [0, 1]}}
        )
        assert (
            str(loaded.robots.blue[0].start)
            == "0.5 to 1 m from the ball, bearing 0 to 1 rad, heading towards ball"
        )
        assert str(loaded.ball) == "in the box x 0 to 1 m, y 0 to 1 m"

    @pytest.mark.parametrize(
        ("changes", "expected"),
        [
            (
                {"robots": {"blue": [robot(start={"position": [-5, 0]})]}},
                "robots.blue.0.start.position: (-5, 0) lies outside the field, which is 9 m x 6 m",
            ),
            (
                {"robots": {"blue": [robot(start={"position": {"x": [0, 9], "y": [0, 1]}})]}},
                "robots.blue.0.start.position: (9, 0) lies outside",
            ),
            (
                {"robots": {"blue": [robot(start={"position": {"x": [1, 0], "y": [0, 1]}})]}},
                "robots.blue.0.start.position.x: the lower bound 1 is above the upper bound 0",
            ),
            (
                {"robots": {"blue": [robot(start={"position": {"centre": [0, 1]}})]}},
                "robots.blue.0.start.position.centre: there is no such field; there are x, y",
            ),
            (
                {"robots": {"blue": [robot(start={"position": {"around": "ball", "baring": [0, 1]}})]}},
                "robots.blue.0.start.position.baring: there is no such field; there are around, distance",
            ),
            (
                {"robots": {"blue": [robot(), robot(1, start={"position": [-2.1, 0]})]}},
                "robots.blue.1.start: blue 1 would overlap blue 0",
            ),
            (
                {"robots": {"blue": [robot()], "yellow": [robot(start={"position": [2, 0]})]}},
                "robots.yellow.0.start: yellow 0 would overlap blue 0",
            ),
            (
                {"ball": {"position": [-2.0, 0.1]}},
                "robots.blue.0.start: blue 0 would overlap the ball (to start",
            ),
            ({"ball": {"position": [9, 0]}}, "ball.position: (9, 0) lies outside"),
            (
                {"ball": {"held_by": "yellow 0"}},
                "ball.held_by: no robot is called 'yellow 0'; there are blue 0",
            ),
            ({"ball": {"held_by": "blue ²"}}, "ball.held_by: no robot is called"),
            ({"ball": {}}, "ball: give either position or held_by"),
            ({"ball": {"held_by": "blue 0", "velocity": [1, 0]}}, "ball: a ball that a robot holds"),
            (
                {"ball": {"position": {"around": "ball", "distance": [1, 2]}}},
                "ball: the ball cannot be placed around",
            ),
            (
                {
                    "ball": {"held_by": "blue 0"},
                    "robots": {"blue": [robot(start={"position": [0, 0], "heading": "towards ball"})]},
                },
                "robots.blue.0.start.heading: it holds the ball",
            ),
            (
                {
                    "ball": {"held_by": "blue 0"},
                    "robots": {"blue": [robot(start={"position": {"around": "ball", "distance": [0, 1]}})]},
                },
                "robots.blue.0.start.position: it holds the ball",
            ),
            (
                {
                    "robots": {
                        "blue": [robot(), robot(1, start={"position": {"center": [-2, 0], "radius": 0.1}})]
                    }
                },
                "robots.blue.1.start: no free place within 0.1 m of (-2, 0) m found in 1000 tries",
            ),
            (
                {"robots": {"blue": [robot(start={"position": [0, 1], "heading": "towards sun"})]}},
                "robots.blue.0.start.heading: input should be 'towards ball' or 'towards goal'",
            ),
            (
                {
                    "robots": {
                        "blue": [
                            robot(goalkeeper=True),
                            robot(1, goalkeeper=True, start={"position": [0, 1]}),
                        ]
                    }
                },
                "robots.blue.1.goalkeeper: blue has two goalkeepers",
            ),
        ],
        ids=lambda value: str(value)[:60] if isinstance(value, str) else "",
    )
    def test_starts_that_cannot_be_are_refused_with_their_field(self, changes: dict[str, Any], expected: str):
        assert problem(**changes).removeprefix("test.yaml: ").startswith(expected)


class TestDocumentation:
    text = (Path(__file__).parents[3] / "docs" / "scenarios.md").read_text()

    def test_its_example_is_a_scenario(self):
        example = self.text.partition("```yaml\n")[2].partition("```")[0]
        assert scenario_from(parse_marked(example, "yaml").plain(), "docs").trials == 100

    @pytest.mark.parametrize("model", [Scenario, RobotSetup, RobotStart, BallStart, Box, Disc, Around, Ends])
    def test_every_field_is_explained(self, model: type[BaseModel]):
        assert [name for name in model.model_fields if not re.search(rf"\b{name}\b", self.text)] == []
