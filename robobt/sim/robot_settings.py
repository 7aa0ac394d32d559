"""Settings of the simulated robots' parts: body, wheels, what the ball meets, dribbler, kicker."""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar, Literal

from pydantic import Field

from robobt.config.validation import Settings
from robobt.world.state import ROBOT_RADIUS


class JawSettings(Settings):
    """Where the body goes on beside and ahead of the mouth, so that the ball lies in a notch."""

    front: float = Field(0.0789, gt=0.03, lt=ROBOT_RADIUS, description="centre to the jaws' front [m]")
    opening: float = Field(0.0722, gt=0.05, le=0.16, description="width between the jaws [m]")
    rounding: float = Field(0.004, ge=0, le=0.01, description="radius of their corners [m]")


class BodySettings(Settings):
    """A robot's body: a disc cut flat at the front, with the mouth in the flat."""

    mass: float = Field(2.5, gt=0.1, le=20, description="mass [kg]")
    face: float = Field(0.075, gt=0.03, lt=ROBOT_RADIUS, description="centre to the flat front [m]")
    mouth_width: float = Field(
        0.08, gt=0.02, le=0.16, description="width in which ball counts as in the mouth [m]"
    )
    sensor_depth: float = Field(
        0.01, gt=0.0005, le=0.03, description="gap to the front that still counts [m]"
    )
    jaws: JawSettings | None = Field(None, description="beside a mouth that lies back; none without")


class WheelSettings(Settings):
    """Four omnidirectional wheels that slip, and how grSim commands them.

    Left out (None), a robot follows its command within its limits and never slips.
    """

    angles: tuple[float, float, float, float] = Field(
        (60.0, 135.0, 225.0, 300.0), description="where the wheels are, from the heading [deg]"
    )
    radius: float = Field(0.027, gt=0.005, le=0.1, description="of a wheel [m]")
    inner_edge: float = Field(0.085, gt=0.01, le=0.2, description="centre to the rim's inner edge [m]")
    outer_edge: float = Field(0.09, gt=0.01, le=0.2, description="centre to the rim's outer edge [m]")
    command_radius: float = Field(
        0.09, gt=0.01, le=0.2, description="arm by which a turning rate is commanded [m]"
    )
    mass: float = Field(2.82, gt=0.1, le=20, description="of the robot with its wheels [kg]")
    inertia: float = Field(0.0145, gt=0.0005, le=1, description="of it about the vertical [kg m^2]")
    wheel_mass: float = Field(0.2, gt=0.001, le=2, description="of one wheel [kg]")
    centre: float = Field(-0.002, ge=-0.05, le=0.05, description="centre of mass, ahead of the centre [m]")
    height: float = Field(0.074, ge=0.001, le=0.2, description="centre of mass above the ground [m]")
    torque: float = Field(0.17, gt=0, le=10, description="most that a wheel's motor gives [N m]")
    grip_ahead: float = Field(
        0.26,
        gt=0.01,
        le=1,
        description="share of the load moved by acceleration ahead that the grip feels",
    )
    grip_aside: float = Field(
        0.17,
        gt=0.01,
        le=1,
        description="share of the load moved by acceleration aside that the grip feels",
    )
    tangent_friction: float = Field(0.8, gt=0, le=5, description="coefficient where the wheel drives")
    axial_friction: float = Field(0.05, ge=0, le=5, description="coefficient where its rollers roll")
    load_lag: float = Field(
        0.005, gt=0.0001, le=1, description="time in which the loads follow the acceleration [s]"
    )
    acceleration: float = Field(
        4.147, gt=0, le=50, description="most by which the commanded speed leads the robot's [m/s^2]"
    )
    frame: float = Field(1 / 60, gt=0.0005, le=0.1, description="time from one wheel command to the next [s]")


class ShellSettings(Settings):
    """What the ball meets on a robot with wheels: a front plate as wide as the mouth, the wheels, a core.

    Left out (None), it meets a disc cut flat at the front.
    """

    core: float = Field(0.0485, gt=0.02, lt=ROBOT_RADIUS, description="radius of the core [m]")
    wheel_width: float = Field(
        0.0528, gt=0.005, le=0.1, description="of a wheel at the height of the ball's centre [m]"
    )
    softness: float = Field(
        0.2, gt=0, le=1, description="share of its depth by which a ball is pushed out in a step"
    )


class DribblerSettings(Settings):
    """How the dribbler holds the ball.

    ``force`` pulls the ball towards the front with a limited acceleration, so the
    ball is lost when holding it would take more: turning at w with the ball's
    centre at distance L needs w^2 L, driving backwards needs the robot's own
    acceleration. ``glue`` carries the ball rigidly, as grSim's hinge does.
    ``roller`` does not pull: a driven roller spins the ball backwards, and the
    ground drives the spinning ball against it, as in ER-Force's simulator.
    """

    kind: Literal["force", "glue", "roller"] = "force"
    pull: float = Field(4.0, ge=0, le=200, description="largest pull towards the front [m/s^2]")
    side: float = Field(6.0, ge=0, le=200, description="largest sideways acceleration [m/s^2]")
    reach: float = Field(0.012, gt=0, le=0.1, description="gap up to which it pulls [m]")
    centring: float = Field(0.05, gt=0.005, le=5, description="time constant towards the middle [s]")
    idle_hold: float = Field(
        0.0,
        ge=0,
        le=200,
        description="as pull and side, with the dribbler off and the robot not backing away [m/s^2]",
    )
    roller_speed: float = Field(1.05, gt=0, le=20, description="of a roller's surface [m/s]")
    roller_friction: float = Field(1.5, ge=0, le=5, description="coefficient of ball and roller")
    roller_restitution: float = Field(
        0.1, ge=0, le=1, description="of ball and driven roller; an idle one has the front's"
    )
    ground_friction: float = Field(
        0.35, ge=0, lt=1, description="coefficient of the ground and a ball at a roller"
    )


class KickerSettings(Settings):
    """The kicker. What a kick makes of the ball's own velocity, the robot's limits say.

    The speed of each kick is drawn from random numbers of the field's own, which follow from its seed.
    """

    renamed: ClassVar[Mapping[str, str]] = {"damping": "limits.touch_returned of the simulator"}

    max_speed: float = Field(6.5, gt=0, le=20, description="fastest ball after a kick [m/s]")
    speed_spread: float = Field(
        0.0, ge=0, le=0.3, description="standard deviation of kicks' speeds, as a share of the commanded"
    )
    recharge: float = Field(0.1, ge=0, le=10, description="no kick and no dribbling after a kick [s]")
    charge: float = Field(0.0, ge=0, le=30, description="time after a kick until the next can be fired [s]")
    chip_angle: float | None = Field(
        45.0, gt=0, lt=90, description="of every chip, from the ground [deg]; none for the one commanded"
    )
    chip_yield: float = Field(1.0, gt=0, le=1, description="share of the commanded speed that a chip has")
    max_chip_speed: float = Field(6.5, gt=0, le=20, description="fastest ball after a chip [m/s]")
