"""A ball that is kicked on with one touch goes where it was aimed, by what the robot's limits say of it."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, pi, radians, sin

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.motion.catch import MOUTH
from robobt.motion.dribbling import velocity_for_kick
from robobt.sim import SimSettings, preset, settings_from
from robobt.skills.tactics.chances import aim_of, redirect_kick
from robobt.skills.tactics.receive_pass import ReceivePass
from robobt.testing import Trial, blue, robot
from robobt.world import KickTrigger, Placement, RobotCommand, RobotLimits
from robobt.world.geometry import wrap_angle
from tests.sim.rig import ME, one_robot


def touching(kept: float, returned: float) -> SimSettings:
    """Robots whose kicks on the first touch treat the ball so."""
    return settings_from({"limits": {"touch_kept": kept, "touch_returned": returned}})


def kicked_on(limits: RobotLimits, speed: float, angle: float, kick: float, drifts: float) -> float:
    """Aim a ball that comes at an angle along the x axis; return the angle at which it leaves [rad].

    Args:
        limits: of the robot.
        speed: of the ball [m/s].
        angle: between where it comes from and where it is to go [rad].
        kick: speed with which it is to leave ahead [m/s].
        drifts: the robot's velocity along y [m/s].
    """
    vx, vy = -speed * cos(angle), -speed * sin(angle)
    me = robot(velocity=(0.0, drifts, 0.0), limits=limits)
    incoming = velocity_for_kick(me, vx, vy)
    heading = aim_of(1.0, 0.0, *incoming, kick, 20.0)
    c, s = cos(heading), sin(heading)
    ahead = redirect_kick(c * incoming[1] - s * incoming[0], kick, 20.0)
    command = RobotCommand(
        s * drifts,
        c * drifts,
        kick_speed=ahead + limits.touch_returned * (c * vx + s * vy),
        kick_trigger=KickTrigger.ON_CONTACT,
    )
    # It meets the mouth after 0.05 s.
    late = 0.05
    ball = (MOUTH * c - late * vx, MOUTH * s + late * (drifts - vy), vx, vy)
    world = one_robot(touching(limits.touch_kept, limits.touch_returned), limits=limits)
    world.reset(Placement({ME: (0.0, 0.0, heading)}, ball, {ME: (0.0, drifts)}), seed=0)
    while not world.kicks:
        world.act({ME: command})
        assert world.time < 0.2, "it never kicks"
    after = world.truth().ball
    return atan2(after.vy, after.vx)


def test_the_ball_of_real_fields_goes_where_it_is_aimed() -> None:
    # Aimed as for a ball that keeps all of its speed across, it leaves by 19 degrees beside it.
    for angle in (-45.0, 45.0):
        off = kicked_on(RobotLimits(touch_kept=0.4, touch_returned=0.1), 4.0, radians(angle), 4.5, 0.0)
        assert abs(degrees(off)) < 2.0


@settings(max_examples=40, deadline=None)
@given(
    kept=st.floats(0.0, 1.0),
    returned=st.floats(0.0, 0.6),
    speed=st.floats(1.5, 4.0),
    angle=st.floats(-1.0, 1.0),
    drifts=st.floats(-0.5, 0.5),
)
def test_it_does_whatever_a_touch_keeps_and_returns(
    kept: float, returned: float, speed: float, angle: float, drifts: float
) -> None:
    off = kicked_on(RobotLimits(touch_kept=kept, touch_returned=returned), speed, angle, 4.5, drifts)
    assert abs(degrees(off)) < 2.0


def redirected(seed: int, played: SimSettings) -> float | None:
    """Roll a ball to a robot before the goal; return how far beside its aim it sends it on [rad]."""
    rng = np.random.default_rng(seed)
    x, y = rng.uniform(1.5, 2.8), rng.uniform(-1.2, 1.2)
    from_where = atan2(-y, 4.5 - x) + rng.choice((-1.0, 1.0)) * rng.uniform(0.4, 0.9)
    px, py = x + 2.0 * cos(from_where), y + 2.0 * sin(from_where)
    speed = rng.uniform(2.0, 4.0)
    ball = (px, py, -speed * cos(from_where), -speed * sin(from_where))
    way = rng.uniform(-pi, pi)
    pose = (x + 0.15 * cos(way), y + 0.15 * sin(way), from_where)
    trial = Trial({blue(1): ReceivePass(redirect_at=0.0)}, {blue(1): pose}, ball, played)
    while trial.world.time < 2.0:
        shot = trial.stores[blue(1)].shot
        ball_now = trial.tick().ball
        if trial.kicks:
            if shot is None or hypot(ball_now.vx, ball_now.vy) < 3.0:
                return None
            wanted = atan2(shot.target[1] - ball_now.y, shot.target[0] - ball_now.x)
            return abs(wrap_angle(atan2(ball_now.vy, ball_now.vx) - wanted))
    return None


@pytest.mark.integration
@pytest.mark.parametrize("name", ["default", "sumatra", "real_2023", "real_2025", "raven_2"])
def test_a_pass_is_sent_on_at_its_aim_in_presets_of_real_fields(name: str) -> None:
    found = [redirected(seed, preset(name)) for seed in range(12)]
    sent = [degrees(off) for off in found if off is not None]
    assert len(sent) >= 9
    assert sum(off < 2.0 for off in sent) >= len(sent) - 1
