"""Trials: who moves, when a run ends, and what a statement that does not hold says."""

from __future__ import annotations

import pytest

from robobt.sim import settings_from
from robobt.skills import GoToBall, GoToPose, Skill, Stop
from robobt.testing import Trial, alone, always, blue, eventually, fails, never, succeeds, yellow
from robobt.tree import Sequence, Status, TreeError
from robobt.world import Frame


class Raises(Skill):
    def on_running(self) -> Status:
        raise LookupError("nothing there")


def standing() -> Trial:
    return alone(Stop(), (0.0, 1.0, 0.0), ball=(2.0, 0.0))


def test_robots_with_a_tree_move_and_the_others_stand() -> None:
    poses = {blue(0): (-1.0, 0.0, 0.0), yellow(2): (1.0, 2.0, 0.0)}
    end = Trial({blue(0): GoToPose(target=(0.0, 1.0))}, poses, ball=(3.0, 0.0)).run(3.0)
    assert end.own[0].position == pytest.approx((0.0, 1.0), abs=0.05)
    assert (end.opponents[0].id, end.opponents[0].position) == (2, (1.0, 2.0))


def test_yellow_plays_towards_the_other_side() -> None:
    trial = Trial({yellow(0): GoToPose(target=(1.0, 0.0))}, {yellow(0): (0.0, 0.0, 0.0)}, ball=(0.0, 2.0))
    assert trial.run(3.0).opponents[0].x == pytest.approx(-1.0, abs=0.05)


def test_without_an_eventually_all_of_the_time_is_played() -> None:
    trial = standing()
    assert trial.run(0.5, always("true", lambda _: True)).time == pytest.approx(0.5)
    assert len(trial.frames) == 31


def test_a_run_ends_once_everything_has_happened() -> None:
    at = {"first": 0.2, "second": 0.1}
    statements = [
        eventually(what, lambda frame, time=time: frame.time == pytest.approx(time))
        for what, time in at.items()
    ]
    assert standing().run(1.0, *statements).time == pytest.approx(0.2)


def test_what_never_happened_is_named() -> None:
    with pytest.raises(AssertionError, match=r"^in 0.1 s not once: it flies; it sings$"):
        standing().run(
            0.1,
            eventually("it flies", lambda _: False),
            eventually("it is there", lambda _: True),
            eventually("it sings", lambda _: False),
        )


def test_what_does_not_always_hold_is_named_with_its_time() -> None:
    def early(frame: Frame) -> bool:
        return frame.time < 0.09

    with pytest.raises(AssertionError, match=r"^at 0.100 s not always: early$"):
        standing().run(1.0, always("early", early))
    with pytest.raises(AssertionError, match=r"^at 0.100 s not always: not: late$"):
        standing().run(1.0, never("late", lambda frame: not early(frame)))


def test_what_does_not_hold_at_the_start_does_not_always_hold() -> None:
    with pytest.raises(AssertionError, match=r"^at 0.000 s not always: started$"):
        standing().run(1.0, always("started", lambda frame: frame.time > 0.0))
    with pytest.raises(AssertionError, match=r"^at 0.000 s not always: not: at rest$"):
        standing().run(1.0, never("at rest", lambda frame: frame.time == 0.0))


def test_a_node_is_not_asked_for_its_status_before_it_was_ticked() -> None:
    stop = Stop()
    trial = alone(Sequence("all", memory=False, children=[stop]), (0.0, 1.0, 0.0), ball=(2.0, 0.0))
    with pytest.raises(AssertionError, match=r"^at 0.017 s not always: it fails$"):
        trial.run(0.1, always("it fails", fails(stop)))
    with pytest.raises(AssertionError, match=r"^at 0.017 s not always: it fails$"):
        trial.run(0.1, always("it fails", fails(stop)))


def test_a_second_run_goes_on() -> None:
    trial = standing()
    trial.run(0.1)
    assert trial.run(0.1).time == pytest.approx(0.2)


def test_a_node_inside_of_a_tree_is_watched() -> None:
    go, stop = GoToBall(), GoToPose()  # nobody says where to
    trial = alone(Sequence("both", memory=True, children=[go, stop]), (-1.0, 0.0, 0.0))
    trial.run(4.0, eventually("it is at the ball", succeeds(go)))
    trial.run(0.1, eventually("it does not know where to go", fails(stop)))


def test_a_skill_that_raises_fails_the_test() -> None:
    with pytest.raises(TreeError, match="Raises: LookupError: nothing there"):
        alone(Raises(), (0.0, 0.0, 0.0)).tick()


def test_a_robot_with_a_tree_needs_a_pose() -> None:
    with pytest.raises(ValueError, match="yellow 3 is not on the field: give it a pose"):
        Trial({yellow(3): Stop()}, {blue(0): (0.0, 0.0, 0.0)})


def test_kicks_are_counted() -> None:
    class Kick(Skill):
        def on_running(self) -> Status:
            self.store.command.kick_speed = 3.0
            return self.run()

    trial = alone(Kick(), (0.0, 0.0, 0.0), ball=(0.0965, 0.0))
    trial.run(0.2)
    assert [robot for _, robot in trial.kicks] == [blue(0)]


def test_noise_follows_from_the_seed() -> None:
    settings = settings_from({"realism": "realistic"})

    def noisy(seed: int) -> list[tuple[float, float]]:
        trial = Trial({blue(0): GoToBall()}, {blue(0): (-2.0, 0.0, 0.0)}, settings=settings, seed=seed)
        trial.run(1.0)
        return [frame.own[0].position for frame in trial.frames]

    assert noisy(1) == noisy(1) != noisy(2)
