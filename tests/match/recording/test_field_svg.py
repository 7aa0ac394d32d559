import re
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from math import hypot, nan, pi

import pytest

from robobt.match.recording.field_svg import field_svg
from robobt.world import DIVISION_A, DIVISION_B, BallState, FieldGeometry, Frame, RobotId, RobotState, Team

SVG = "{http://www.w3.org/2000/svg}"
BLUE, YELLOW = "#2f6fed", "#f2c21b"


def scene() -> Frame:
    return Frame(
        0.0,
        DIVISION_B,
        BallState(1.0, 0.6),
        (RobotState(3, 1.0, 0.5, pi / 2, ball_contact=True), RobotState(11, -2.0, -1.0)),
        (RobotState(0, 4.3, 0.0, pi),),
    )


def draw(*args: object, **more: object) -> ElementTree.Element:
    return ElementTree.fromstring(field_svg(*args, **more))  # type: ignore[arg-type]


def rects(root: ElementTree.Element) -> list[tuple[float, ...]]:
    keys = ("x", "y", "width", "height")
    return [tuple(float(rect.get(key, "nan")) for key in keys) for rect in root.iter(f"{SVG}rect")]


def texts(root: ElementTree.Element) -> list[str]:
    return [text.text or "" for text in root.iter(f"{SVG}text")]


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B])
def test_the_field_is_drawn_to_scale(field: FieldGeometry) -> None:
    root = draw(replace(scene(), field=field))
    drawn = rects(root)
    assert (-field.length / 2, -field.width / 2, field.length, field.width) in drawn
    depth, across = field.defense_depth, field.defense_width
    assert (-field.length / 2, -across / 2, depth, across) in drawn
    assert (field.length / 2 - depth, -across / 2, depth, across) in drawn
    assert (field.length / 2, -field.goal_width / 2, field.goal_depth, field.goal_width) in drawn
    circles = [circle.get("r") for circle in root.iter(f"{SVG}circle")]
    assert circles == ["0.5", "0.0215"]
    box = [float(part) for part in root.get("viewBox", "").split()]
    assert box[2:] == pytest.approx([field.length + 2 * field.margin, field.width + 2 * field.margin])


def test_robots_stand_where_they_are_with_a_flat_front() -> None:
    body = next(path for path in draw(scene()).iter(f"{SVG}path") if path.get("fill") == BLUE)
    x1, y1, *_, x2, y2 = [float(part) for part in re.findall(r"-?[\d.]+", body.get("d", ""))]
    # Up on the field is down in the picture's coordinates.
    for x, y in ((x1, -y1), (x2, -y2)):
        assert hypot(x - 1.0, y - 0.5) == pytest.approx(0.09, abs=2e-4)
        assert y - 0.5 == pytest.approx(0.075, abs=2e-4)
    assert x1 == pytest.approx(2.0 - x2, abs=2e-4)


def test_numbers_and_team_colours_are_those_of_the_frame() -> None:
    root = draw(scene())
    assert texts(root) == ["3", "11", "0"]
    fills = [path.get("fill") for path in root.iter(f"{SVG}path") if path.get("fill") in (BLUE, YELLOW)]
    assert fills == [BLUE, BLUE, YELLOW]


def test_each_team_sees_its_own_goal_on_the_left() -> None:
    for view, own in ((scene(), BLUE), (scene().mirrored(), YELLOW)):
        nets = [rect for rect in draw(view).iter(f"{SVG}rect") if rect.get("fill-opacity") == ".3"]
        left = min(nets, key=lambda rect: float(rect.get("x", "nan")))
        assert left.get("fill") == own


def test_a_mouth_with_the_ball_in_it_shows() -> None:
    mouths = [path.get("stroke") for path in draw(scene()).iter(f"{SVG}path") if not path.get("fill")]
    assert mouths == ["#ff7a1a", "#14202b", "#14202b"]


def trails(root: ElementTree.Element) -> list[ElementTree.Element]:
    return [path for path in root.iter(f"{SVG}path") if path.get("stroke-linecap") == "round"]


def test_the_trail_grows_stronger_and_ends_at_its_last_point() -> None:
    pieces = trails(draw(scene(), trail=[(0.05 * step, 0.1) for step in range(100)]))
    strengths = [float(piece.get("stroke-opacity", "nan")) for piece in pieces]
    assert strengths == sorted(strengths)
    assert 10 < len(pieces) <= 24
    assert pieces[-1].get("d", "").endswith("L4.95 -0.1")


def test_the_trail_is_not_drawn_across_a_jump() -> None:
    points = [(0.0, 0.0), (0.1, 0.0), (3.0, 2.0), (nan, 0.0), (3.1, 2.0)]
    drawn = " ".join(piece.get("d", "") for piece in trails(draw(scene(), trail=points)))
    assert drawn == "M0 0L0.1 0 M3 -2L3.1 -2"
    assert not trails(draw(scene(), trail=[(0.0, 0.0)]))


def test_labels_are_text_whatever_they_say() -> None:
    labels = {RobotId(Team.BLUE, 3): "<b>kick & run</b>", RobotId(Team.YELLOW, 9): "nobody"}
    assert texts(draw(scene(), labels=labels)) == ["3", "11", "0", "<b>kick & run</b>"]


def test_a_window_shows_a_part_of_the_field() -> None:
    root = draw(scene(), window=(0.0, -1.5, 4.8, 1.5), width=800)
    assert root.get("viewBox") == "0 -1.5 4.8 3"
    assert (root.get("width"), root.get("height")) == ("800", "500")


def test_a_ball_nobody_sees_is_not_drawn() -> None:
    circles = [
        circle.get("r") for circle in draw(replace(scene(), ball=BallState(nan, 0.0))).iter(f"{SVG}circle")
    ]
    assert circles == ["0.5"]
