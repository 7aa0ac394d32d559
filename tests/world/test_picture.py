"""A frame and a result show themselves in a notebook."""

from __future__ import annotations

from dataclasses import replace
from xml.etree import ElementTree

import robobt


def test_a_frame_is_a_picture_with_every_robot_and_the_ball() -> None:
    match = robobt.Match(robobt.load_scenario("three_v_three"))
    frame = match.players[0].store.frame
    root = ElementTree.fromstring(frame._repr_svg_())
    texts = [node.text for node in root.iter("{http://www.w3.org/2000/svg}text")]
    assert sorted(texts) == sorted(str(robot.id) for robot in (*frame.own, *frame.opponents))
    ball = list(root.iter("{http://www.w3.org/2000/svg}circle"))[-1]
    assert (float(ball.get("cx", "")), -float(ball.get("cy", ""))) == (frame.ball.x, frame.ball.y)


def test_a_result_is_a_table_whatever_its_scenario_is_called() -> None:
    result = robobt.play_match(robobt.load_scenario("table4_trial1_own").lasting(0.1))
    table = ElementTree.fromstring(replace(result, scenario="<b>")._repr_html_())
    assert table[0].text == "<b>, trial 0"
    assert "outcome" in "".join(table.itertext())
