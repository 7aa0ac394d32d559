"""A robot's limits, shared by pilots, raters and the simulator."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

from pydantic import Field

from robobt.config.validation import Settings


class RobotLimits(Settings):
    """Limits of one robot's motion, SI units.

    ``side_acceleration`` and ``side_braking`` default to the forward values,
    ``turn_braking`` to ``turn_acceleration``, ``receive_speed`` to ``catch_speed``. The
    defaults are the typical league robot of the simulators' presets: 3 m/s, 3 m/s^2,
    braking at 6 m/s^2, and a dribbler that pulls at the ball with 4 m/s^2.

    A real robot answers a commanded velocity late and in part. After ``dead_time`` its controller follows the
    command with the first-order ``lag`` of each axis; of what it follows it reaches the share ``gain``, and
    ``cross_ahead`` of the sideways and ``cross_aside`` of the forward velocity appear on the other axis. The
    speeds and accelerations above limit the result.
    """

    renamed: ClassVar[Mapping[str, str]] = {"kick_rebound": "touch_returned"}

    max_speed: float = Field(3.0, gt=0, le=10, description="top speed in any direction [m/s]")
    acceleration: float = Field(3.0, gt=0, le=50, description="speeding up along the heading [m/s^2]")
    braking: float = Field(6.0, gt=0, le=50, description="slowing down along the heading [m/s^2]")
    side_acceleration: float | None = Field(None, gt=0, le=50, description="speeding up sideways [m/s^2]")
    side_braking: float | None = Field(None, gt=0, le=50, description="slowing down sideways [m/s^2]")
    separate_axes: bool = Field(
        False,
        description="whether speeding up and braking ahead and sideways are limited independently; "
        "by default an ellipse joins the limits",
    )
    max_turn: float = Field(10.0, gt=0, le=100, description="top turning rate [rad/s]")
    turn_acceleration: float = Field(50.0, gt=0, le=5000, description="change of the turning rate [rad/s^2]")
    turn_braking: float | None = Field(None, gt=0, le=5000, description="slowing a turn down [rad/s^2]")
    catch_speed: float = Field(
        0.5, gt=0, le=10, description="speed relative to a ball at which the dribbler still takes it [m/s]"
    )
    receive_speed: float | None = Field(
        None, gt=0, le=10, description="that speed for a ball that meets a robot that does not brake [m/s]"
    )
    hold_acceleration: float = Field(
        3.0, gt=0, le=100, description="acceleration, as by braking or turning, at which it keeps it [m/s^2]"
    )
    hold_straight: float | None = Field(
        None,
        gt=0,
        le=100,
        description="that acceleration while it does not turn, if it is larger; None: no larger [m/s^2]",
    )
    carry_aside: float | None = Field(
        None, gt=0, le=10, description="speed sideways at which it keeps it; None: any [m/s]"
    )
    reaction: float = Field(
        0.0,
        ge=0,
        le=0.05,
        description="time beside the dead time that no frame is predicted over, as pilots allow for it [s]",
    )
    dead_time: float = Field(
        0.0, ge=0, le=0.3, description="time from a command's arrival to the robot's first motion [s]"
    )
    lag: float = Field(0.0, ge=0, le=0.3, description="time constant along the heading [s]")
    side_lag: float = Field(0.0, ge=0, le=0.3, description="time constant sideways [s]")
    turn_lag: float = Field(0.0, ge=0, le=0.3, description="time constant of turning [s]")
    gain: float = Field(1.0, gt=0.2, le=2, description="share of a forward velocity that is reached")
    side_gain: float = Field(1.0, gt=0.2, le=2, description="share of a sideways velocity that is reached")
    turn_gain: float = Field(1.0, gt=0.2, le=2, description="share of a turning rate that is reached")
    cross_ahead: float = Field(
        0.0, ge=-0.5, le=0.5, description="share of a sideways velocity that appears ahead"
    )
    cross_aside: float = Field(
        0.0, ge=-0.5, le=0.5, description="share of a forward velocity that appears to the left"
    )
    touch_kept: float = Field(
        1.0, ge=0, le=1, description="share of a ball's sideways velocity, seen by the robot, kept by a kick"
    )
    touch_returned: float = Field(
        0.0, ge=0, le=1, description="share of the speed of a ball that comes at the robot which a kick adds"
    )
    kick_carried: float | None = Field(
        None,
        ge=-1,
        le=1,
        description="share of the forward speed of a ball that moves with the robot which a kick adds; "
        "by default it loses the share touch_returned",
    )

    @property
    def carried(self) -> float:
        """Share of the forward speed of a ball that moves with the robot which a kick adds."""
        return -self.touch_returned if self.kick_carried is None else self.kick_carried

    @property
    def lateral_acceleration(self) -> float:
        """Acceleration sideways [m/s^2]."""
        return self.acceleration if self.side_acceleration is None else self.side_acceleration

    @property
    def lateral_braking(self) -> float:
        """Braking sideways [m/s^2]."""
        return self.braking if self.side_braking is None else self.side_braking

    @property
    def receives(self) -> float:
        """Speed at which a ball may come at the dribbler [m/s]."""
        return self.catch_speed if self.receive_speed is None else self.receive_speed

    @property
    def holds_straight(self) -> float:
        """Acceleration at which a robot that does not turn keeps the ball [m/s^2]."""
        return max(self.hold_acceleration, self.hold_straight or 0.0)

    @property
    def angular_braking(self) -> float:
        """Rate at which a turn is slowed down [rad/s^2]."""
        return self.turn_acceleration if self.turn_braking is None else self.turn_braking

    def obeys_after(self, command_delay: float) -> float:
        """Return how long after a command is sent the robot begins to follow it [s].

        With the age of a picture it is the whole delay, from a command to its seen effect. Predictions let
        commands take effect by it; they show the robot at :meth:`shown_after`.

        Args:
            command_delay: of network and radio, from the command's sending to its arrival [s].
        """
        return command_delay + self.reaction + self.dead_time

    def shown_after(self, command_delay: float) -> float:
        """Return how far beyond the present a frame shows the robot [s].

        It is :meth:`obeys_after` without ``reaction``, for which pilots allow by :attr:`trailing_time`.

        Args:
            command_delay: of network and radio, from a command's sending to its arrival [s].
        """
        return command_delay + self.dead_time

    @property
    def trailing_time(self) -> float:
        """Time by which motion trails a command beyond the moment that a frame shows [s]."""
        return self.reaction + self.longest_lag

    @property
    def longest_lag(self) -> float:
        """The longest time constant of an axis [s]."""
        return max(self.lag, self.side_lag, self.turn_lag)

    @property
    def answers_as_commanded(self) -> bool:
        """Whether the robot reaches each velocity that it is commanded: gains of 1, no cross-talk."""
        return (
            self.gain,
            self.side_gain,
            self.turn_gain,
            self.cross_ahead,
            self.cross_aside,
        ) == _AS_COMMANDED

    def command_for(self, vx: float, vy: float, omega: float) -> tuple[float, float, float]:
        """Return the command by which the robot reaches a velocity, all in its own frame.

        Args:
            vx: wanted velocity ahead [m/s].
            vy: wanted velocity to the left [m/s].
            omega: wanted turning rate [rad/s].

        Returns:
            velocity ahead, to the left and turning rate to command; for gains below 1 it may be faster than
            ``max_speed``, which limits what the robot reaches.
        """
        if self.answers_as_commanded:
            return vx, vy, omega
        whole = self.gain * self.side_gain - self.cross_ahead * self.cross_aside
        ahead = (self.side_gain * vx - self.cross_ahead * vy) / whole
        aside = (self.gain * vy - self.cross_aside * vx) / whole
        return ahead, aside, omega / self.turn_gain

    def scaled(self, factor: float) -> RobotLimits:
        """Return the same robot with its top speed and turning rate times ``factor``.

        Accelerations stay: a goalkeeper at half speed is a robot commanded to drive
        half as fast, not a weaker one.
        """
        return self.model_copy(
            update={"max_speed": self.max_speed * factor, "max_turn": self.max_turn * factor}
        )


def limits_as_named_now(data: object) -> object:
    """Return plain data of limits, by the present names of fields that earlier versions called otherwise.

    For what robobt itself has written, such as recordings; the error for another file names the new field.
    """
    if not isinstance(data, Mapping):
        return data
    return {RobotLimits.renamed.get(str(name), name): value for name, value in data.items()}


_AS_COMMANDED = (1.0, 1.0, 1.0, 0.0, 0.0)

DEFAULT_LIMITS = RobotLimits()
