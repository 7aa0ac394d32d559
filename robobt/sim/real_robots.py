"""Published figures of real robots and fields, from which presets are made.

Sources: the fields, and robots as TIGERs' observer sees them: Sumatra's ``BallParameters.java`` and
``botParamsDatabase.json``, releases 2022 to 2025; four identified robots of one team:
``tools/gen_robot_models.py`` of Rione's ssl-RAVEN-sim. Speed and acceleration are those of the robots, not
what a team commands.
"""

from __future__ import annotations

from typing import NamedTuple

from robobt.world.limits import RobotLimits


class RealField(NamedTuple):
    """How the ball moved on a field, and what a kick on the first touch did to it.

    Deceleration while it slides and rolls [m/s^2], share of a ball's sideways speed that a kick keeps, and
    share of the speed at which it comes that a kick gives back.
    """

    slide_deceleration: float
    roll_deceleration: float
    touch_kept: float
    touch_returned: float


REAL_FIELDS = {
    "real_2022": RealField(3.0, 0.26, 0.35, 0.55),
    "real_2023": RealField(2.79, 0.33, 0.18, 0.07),
    "real_2024": RealField(2.46, 0.29, 0.40, 0.10),
    "real_2025": RealField(3.0, 0.26, 0.40, 0.10),
}
"""Fields of the world championships by year. Source: Sumatra's ``BallParameters.java``."""

REAL_LIMITS = RobotLimits(
    max_speed=3.1,
    acceleration=3.4,
    braking=6.0,
    max_turn=20.0,
    turn_acceleration=50.0,
    catch_speed=1.0,
    receive_speed=3.0,
    dead_time=0.094,
    lag=0.037,
    side_lag=0.038,
    turn_lag=0.030,
)
"""A good robot of the league: TIGERs' own as their observer sees it, with the mean dead time and lag of the
four identified robots, as TIGERs publish none. How fast it takes a ball is an assumption, as in preset
``sumatra``. Source: Sumatra's ``botParamsDatabase.json``."""


def _raven(
    dead_time: float,
    lags: tuple[float, float, float],
    gains: tuple[float, float, float],
    rates: tuple[float, ...],
) -> RobotLimits:
    acceleration, side_acceleration, braking, side_braking = rates
    return RobotLimits(
        # Rims of 2.0 to 2.25 m/s, turning rates of 8.4 to 10 rad/s.
        max_speed=2.1,
        max_turn=9.0,
        acceleration=acceleration,
        side_acceleration=side_acceleration,
        braking=braking,
        side_braking=side_braking,
        dead_time=dead_time,
        lag=lags[0],
        side_lag=lags[1],
        turn_lag=lags[2],
        gain=gains[0],
        side_gain=gains[1],
        turn_gain=gains[2],
    )


IDENTIFIED_ROBOTS = {
    "raven_2": _raven(0.087, (0.043, 0.051, 0.039), (0.76, 0.64, 0.94), (5.5, 3.7, 4.2, 4.7)),
    "raven_4": _raven(0.117, (0.037, 0.038, 0.030), (0.94, 0.57, 1.0), (4.0, 1.7, 4.7, 3.1)),
    "raven_11": _raven(0.110, (0.030, 0.025, 0.022), (0.93, 1.0, 1.0), (3.4, 1.2, 3.9, 1.7)),
    "raven_12": _raven(0.063, (0.037, 0.038, 0.030), (0.98, 0.78, 0.96), (3.8, 2.1, 2.1, 0.9)),
}
"""The four identified robots, by their number."""
