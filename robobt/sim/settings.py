"""Settings of the simulator and its named presets, SI units.

Source of the presets' figures: measurements in the running simulators (grSim,
rSim, ER-Force), which win over what their sources or geometry packets claim,
and the published parameters of TIGERs' Sumatra. At what speed a dribbler takes
the ball and how much acceleration it bears was measured in this one.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from pydantic import Field, ValidationError

from robobt.config.errors import ConfigError, message_of, unknown_name
from robobt.config.validation import Settings, first_problem
from robobt.config.yaml import read_yaml
from robobt.sim.real_robots import IDENTIFIED_ROBOTS, REAL_FIELDS, REAL_LIMITS, RealField
from robobt.sim.realism import RealismSettings, realism_level
from robobt.sim.robot_settings import (
    BodySettings,
    DribblerSettings,
    JawSettings,
    KickerSettings,
    ShellSettings,
    WheelSettings,
)
from robobt.world.ball_model import BallModel
from robobt.world.limits import RobotLimits


class BallSettings(BallModel):
    """The ball: how it moves, what it weighs, and when it rests."""

    mass: float = Field(0.046, gt=0.001, le=1, description="mass [kg]")
    stop_speed: float = Field(0.001, gt=0, le=0.5, description="slower than this is at rest [m/s]")
    placed_rolls: bool = Field(True, description="whether a ball that is placed moving rolls, or slides")
    separate_axes: bool = Field(
        False, description="whether friction stops sliding along the field's x and y axes independently"
    )

    @property
    def model(self) -> BallModel:
        """The part of the ball's settings that frames contain and skills plan with."""
        return BallModel(**self.model_dump(include=set(BallModel.model_fields)))


class ContactSettings(Settings):
    """Restitution and friction of the ball against things, and of robots against each other."""

    front_restitution: float = Field(0.2, ge=0, le=1)
    front_friction: float = Field(0.3, ge=0, le=5)
    hull_restitution: float = Field(0.5, ge=0, le=1)
    hull_friction: float = Field(0.22, ge=0, le=5)
    wall_restitution: float = Field(0.4, ge=0, le=1)
    wall_friction: float = Field(0.3, ge=0, le=5)
    goal_restitution: float = Field(0.3, ge=0, le=1)
    goal_friction: float = Field(0.5, ge=0, le=5)
    goal_back_restitution: float = Field(0.1, ge=0, le=1)
    robot_restitution: float = Field(0.3, ge=0, le=1)
    robot_friction: float = Field(0.2, ge=0, le=5)


class SimSettings(Settings):
    """Everything that makes one simulator differ from another."""

    ball: BallSettings = BallSettings()
    body: BodySettings = BodySettings()
    wheels: WheelSettings | None = Field(None, description="of robots that slip; none without")
    shell: ShellSettings | None = Field(None, description="of robots with wheels; a round hull without")
    limits: RobotLimits = Field(
        RobotLimits(receive_speed=1.6), description="of robots that are given none of their own"
    )
    dribbler: DribblerSettings = DribblerSettings()
    kicker: KickerSettings = KickerSettings()
    contact: ContactSettings = ContactSettings()
    realism: RealismSettings = RealismSettings()
    sub_step: float = Field(0.005, gt=0.0005, le=0.01, description="longest physics step [s]")

    def holds_back(self, limits: RobotLimits) -> float:
        """Return for how long the simulator keeps a command from a robot [s].

        A robot without wheels gets it when it is to obey
        (:meth:`~robobt.world.limits.RobotLimits.obeys_after`). Wheels get it earlier by the robot's
        ``reaction``, because they are that late by themselves.

        Args:
            limits: the robot's.
        """
        delay = self.realism.command_delay
        return limits.obeys_after(delay) if self.wheels is None else limits.shown_after(delay)


_GRSIM_BALL = BallSettings(
    mass=0.043,
    slide_deceleration=10.3,
    switch_share=0.695,
    roll_deceleration=0.701,
    first_hop=0.594,
    other_hops=0.92,
    rebound=0.48,
)

_GRSIM = SimSettings(
    ball=_GRSIM_BALL.model_copy(update={"stop_speed": 0.01, "placed_rolls": False, "separate_axes": True}),
    body=BodySettings(mass=2.82, face=0.0805, mouth_width=0.08, sensor_depth=0.01),
    wheels=WheelSettings(),
    shell=ShellSettings(),
    limits=RobotLimits(
        max_speed=5.0,
        acceleration=4.15,
        braking=3.4,
        side_acceleration=3.67,
        side_braking=4.1,
        max_turn=20.0,
        turn_acceleration=50.0,
        catch_speed=0.6,
        receive_speed=3.0,
        hold_acceleration=50.0,
        carry_aside=1.1,
        reaction=1 / 60,
        touch_returned=0.2,
    ),
    dribbler=DribblerSettings(kind="glue", reach=0.01),
    kicker=KickerSettings(
        max_speed=10.0, recharge=1 / 6, chip_angle=None, chip_yield=0.969, max_chip_speed=10.0
    ),
    contact=ContactSettings(
        front_friction=0.8, hull_friction=0.5, robot_restitution=0.0, robot_friction=0.5, wall_restitution=0.5
    ),
    sub_step=1 / 300,
)


def _real(field: RealField, limits: RobotLimits) -> SimSettings:
    """Return a field with robots of these limits. Kicker: Sumatra's ``bot-configs.json``."""
    touch = {"touch_kept": field.touch_kept, "touch_returned": field.touch_returned}
    return SimSettings(
        ball=BallSettings(
            slide_deceleration=field.slide_deceleration,
            switch_share=0.64,
            roll_deceleration=field.roll_deceleration,
            first_hop=0.78,
            other_hops=0.9,
            rebound=0.48,
        ),
        limits=limits.model_copy(update=touch),
        kicker=KickerSettings(max_speed=8.0, max_chip_speed=8.0, recharge=0.08),
    )


PRESETS: dict[str, SimSettings] = {
    "default": SimSettings(),
    "grsim": _GRSIM,
    "rsim": SimSettings(
        ball=_GRSIM_BALL,
        body=BodySettings(mass=2.42, face=0.081, mouth_width=0.08, sensor_depth=0.01),
        limits=RobotLimits(
            max_speed=4.0,
            acceleration=3.34,
            braking=3.8,
            side_acceleration=2.41,
            side_braking=2.8,
            max_turn=40.0,
            turn_acceleration=50.0,
            catch_speed=4.0,
            hold_acceleration=50.0,
            touch_returned=0.2,
        ),
        dribbler=DribblerSettings(kind="glue", reach=0.01),
        kicker=KickerSettings(
            max_speed=20.0, recharge=0.25, chip_angle=None, chip_yield=0.969, max_chip_speed=20.0
        ),
        contact=ContactSettings(front_restitution=0.05, hull_restitution=0.5, wall_restitution=0.5),
    ),
    "erforce": SimSettings(
        ball=BallSettings(
            mass=0.046,
            slide_deceleration=3.9,
            switch_share=0.645,
            roll_deceleration=0.36,
            first_hop=0.715,
            other_hops=1.0,
            rebound=0.566,
        ),
        body=BodySettings(mass=1.5, face=0.064, mouth_width=0.07, sensor_depth=0.0015, jaws=JawSettings()),
        limits=RobotLimits(
            max_speed=3.0,
            # Fitted to 12 runs of 1.2 s with commands that change every 60 ms on all axes at once.
            acceleration=6.4,
            braking=7.6,
            side_acceleration=4.6,
            side_braking=6.6,
            separate_axes=True,
            max_turn=10.0,
            turn_acceleration=75.0,
            catch_speed=0.5,
            receive_speed=3.0,
            # In a turn it keeps the ball at 2 rad/s; straight, in any direction, at 1 m/s^2 and more.
            hold_acceleration=0.35,
            hold_straight=1.0,
            touch_kept=0.87,
            touch_returned=0.17,
            kick_carried=0.9,
        ),
        dribbler=DribblerSettings(kind="roller"),
        kicker=KickerSettings(max_chip_speed=5.425),  # which first touches down after 3 m
        contact=ContactSettings(
            front_restitution=0.2,
            hull_restitution=0.6,
            wall_restitution=0.3,
            wall_friction=0.35,
            robot_restitution=0.36,
            robot_friction=0.05,
        ),
        # A command moves a robot in the simulator's second tick after it; ticks are 5 ms apart. The pictures
        # are 35 ms old, which is no part of this delay: a world of the league has it as its latency.
        realism=RealismSettings(command_delay=0.005),
    ),
    "sumatra": SimSettings(
        ball=BallSettings(slide_deceleration=2.46, switch_share=0.64, roll_deceleration=0.29),
        body=BodySettings(face=0.075, mouth_width=0.0995),
        limits=RobotLimits(
            max_speed=3.0,
            acceleration=3.0,
            braking=6.0,
            max_turn=20.0,
            turn_acceleration=50.0,
            catch_speed=1.0,
            receive_speed=3.0,
            hold_acceleration=15.0,
            # What its authors expect of simulators; real fields' figures are those of real_2022 to real_2025.
            touch_kept=0.8,
            touch_returned=0.2,
        ),
        dribbler=DribblerSettings(kind="force", pull=20.0, side=20.0, reach=0.01),
        kicker=KickerSettings(max_speed=7.5, max_chip_speed=5.5),
        contact=ContactSettings(front_restitution=0.0, goal_restitution=0.3),
    ),
    "robobulls": SimSettings(
        ball=_GRSIM_BALL,
        body=BodySettings(mass=2.8, face=0.0795, mouth_width=0.08, sensor_depth=0.011),
        limits=_GRSIM.limits.model_copy(
            update={
                "braking": 4.6,
                "catch_speed": 4.0,
                "receive_speed": 4.0,
                "carry_aside": None,
                "reaction": 0.0,
            }
        ),
        dribbler=DribblerSettings(kind="glue", reach=0.011, idle_hold=4.3),
        kicker=KickerSettings(max_speed=7.5, chip_angle=None, chip_yield=0.969, max_chip_speed=10.0),
        contact=ContactSettings(front_restitution=0.06, hull_restitution=0.5, wall_restitution=0.5),
    ),
    **{name: _real(field, REAL_LIMITS) for name, field in REAL_FIELDS.items()},
    **{name: _real(REAL_FIELDS["real_2025"], limits) for name, limits in IDENTIFIED_ROBOTS.items()},
}
"""Named presets. ``robobulls`` has the kicks that RoboBulls' software sends, and a simpler grSim: a robot
that follows its commands within limits, a dribbler that takes every ball and a hull that lets none roll off.
In it RoboBulls' skills need the times of the paper and of the real grSim; with ``grsim``'s wheels and
contacts they push the ball away more often than there."""


def preset(name: str, **changes: object) -> SimSettings:
    """Return a preset with top-level settings replaced by ``changes``.

    Args:
        name: of the preset; or of a YAML file that holds what a scenario does under ``simulator``, as
            ``robobt record identify`` writes it.
        **changes: settings to replace.

    Raises:
        KeyError: no such preset; the message lists those there are.
        ConfigError: the file cannot be read, or holds no settings of a simulator; it names file and field.
    """
    if is_preset_file(name):
        return _from_file(Path(name)).model_copy(update=changes)
    if name not in PRESETS:
        raise KeyError(f"no simulator preset is called {name!r}; {unknown_name(name, sorted(PRESETS))}")
    return PRESETS[name].model_copy(update=changes)


def is_preset_file(name: str) -> bool:
    """Return whether a preset is named as a file of settings, which ends in ``.yaml`` or ``.yml``."""
    return name.lower().endswith((".yaml", ".yml"))


def _from_file(path: Path) -> SimSettings:
    data = read_yaml(path)
    base = data.get("preset", "default")
    if not isinstance(base, str) or is_preset_file(base):
        raise ConfigError(str(path), "must be the name of a shipped preset", "preset")
    try:
        return settings_from(data)
    except ValidationError as error:
        field, problem = first_problem(error, SimSettings, data)
        raise ConfigError(str(path), problem, field) from error
    except KeyError as error:
        raise ConfigError(str(path), message_of(error)) from error


def settings_from(simulator: str | Mapping[str, object]) -> SimSettings:
    """Build settings from what a scenario file holds under ``simulator``.

    A name is a preset, or a preset file. A mapping may name a ``preset`` to start from
    ("default" without one), a ``realism`` level by name, and any setting to
    change, nested as in :class:`SimSettings`.

    Raises:
        KeyError: an unknown preset or realism level.
        ConfigError: a preset file that is wrong.
        pydantic.ValidationError: an unknown setting or a value out of range.
    """
    if isinstance(simulator, str):
        return preset(simulator)
    changes = dict(simulator)
    base = preset(str(changes.pop("preset", "default"))).model_dump()
    realism = changes.get("realism")
    if isinstance(realism, str):
        changes["realism"] = realism_level(realism).model_dump()
    return SimSettings.model_validate(_merged(base, changes))


def _merged(base: Mapping[str, object], changes: Mapping[str, object]) -> dict[str, object]:
    result = dict(base)
    for key, value in changes.items():
        old = result.get(key)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            value = _merged(old, value)
        result[key] = value
    return result
