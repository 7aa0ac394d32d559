"""Tests of one's own skills and plays: robots in the simulator, and what eventually, always or never holds.

``docs/testing.md`` shows how. The fixtures of :mod:`robobt.testing.plugin` are there in every test that
pytest runs where robobt is installed.
"""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily

_HOMES = {
    "Pose": "trial",
    "Predicate": "statements",
    "Statement": "statements",
    "Ticker": "ticking",
    "Trial": "trial",
    "alone": "trial",
    "always": "statements",
    "ball_leaves_the_field": "predicates",
    "ball_near": "predicates",
    "blue": "trial",
    "dribbles_too_far": "predicates",
    "eventually": "statements",
    "fails": "predicates",
    "frame": "frames",
    "goal_for": "predicates",
    "has_ball": "predicates",
    "held": "frames",
    "inside_the_field": "predicates",
    "leaves_the_field": "predicates",
    "make_store": "ticking",
    "never": "statements",
    "robot": "frames",
    "succeeds": "predicates",
    "touches_a_robot": "predicates",
    "touches_inside_area": "predicates",
    "touches_the_ball": "predicates",
    "yellow": "trial",
}

__all__ = list(_HOMES)

if TYPE_CHECKING:
    from robobt.testing.frames import frame as frame
    from robobt.testing.frames import held as held
    from robobt.testing.frames import robot as robot
    from robobt.testing.predicates import ball_leaves_the_field as ball_leaves_the_field
    from robobt.testing.predicates import ball_near as ball_near
    from robobt.testing.predicates import dribbles_too_far as dribbles_too_far
    from robobt.testing.predicates import fails as fails
    from robobt.testing.predicates import goal_for as goal_for
    from robobt.testing.predicates import has_ball as has_ball
    from robobt.testing.predicates import inside_the_field as inside_the_field
    from robobt.testing.predicates import leaves_the_field as leaves_the_field
    from robobt.testing.predicates import succeeds as succeeds
    from robobt.testing.predicates import touches_a_robot as touches_a_robot
    from robobt.testing.predicates import touches_inside_area as touches_inside_area
    from robobt.testing.predicates import touches_the_ball as touches_the_ball
    from robobt.testing.statements import Predicate as Predicate
    from robobt.testing.statements import Statement as Statement
    from robobt.testing.statements import always as always
    from robobt.testing.statements import eventually as eventually
    from robobt.testing.statements import never as never
    from robobt.testing.ticking import Ticker as Ticker
    from robobt.testing.ticking import make_store as make_store
    from robobt.testing.trial import Pose as Pose
    from robobt.testing.trial import Trial as Trial
    from robobt.testing.trial import alone as alone
    from robobt.testing.trial import blue as blue
    from robobt.testing.trial import yellow as yellow
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
