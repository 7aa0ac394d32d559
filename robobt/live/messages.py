"""The messages of a page: JSON, small, few and of known forms."""

from __future__ import annotations

from typing import Annotated, Literal, get_args

from pydantic import Field, JsonValue, TypeAdapter, ValidationError

from robobt.config.validation import Settings
from robobt.live.driving import Frames
from robobt.match.referee.by_hand import Order
from robobt.world.game import Team
from robobt.world.sketch import MOST_LAYERS
from robobt.world.state import RobotId

MOST_MESSAGE_BYTES = 4096
"""The longest message [bytes]."""

RATE, BURST = 200.0, 400.0
"""Number of messages per second that a page may send, and at once."""

MOST_REFUSED = 50
"""Number of invalid messages after which a page is ignored."""

SLOWEST, FASTEST = 0.05, 20.0


class Pause(Settings):
    """Stop the match where it is, or let it go on."""

    do: Literal["pause"]
    on: bool


class Step(Settings):
    """Play this many ticks and pause."""

    do: Literal["step"]
    ticks: int = Field(1, ge=1, le=1000)


class Speed(Settings):
    """Play at this factor of real time."""

    do: Literal["speed"]
    factor: float = Field(ge=SLOWEST, le=FASTEST)


class Reset(Settings):
    """Restart the scenario, with the next or the same seed."""

    do: Literal["reset"]
    next: bool = True


class Seek(Settings):
    """Continue from a time of a recording [s]."""

    do: Literal["seek"]
    time: float = Field(ge=-1e9, le=1e9)


class Steer(Settings):
    """Become the viewer that steers."""

    do: Literal["steer"]


class Past(Settings):
    """Send the stored part of the match."""

    do: Literal["past"]


class Layers(Settings):
    """Let skills draw these layers while this viewer watches."""

    do: Literal["layers"]
    shown: list[Annotated[str, Field(max_length=40)]] = Field(max_length=MOST_LAYERS)


_Metres = Annotated[float, Field(ge=-20, le=20)]
_MetresPerSecond = Annotated[float, Field(ge=-15, le=15)]
_Robot = Annotated[str, Field(pattern=r"^(blue|yellow) \d{1,2}$")]
_Parameters = Annotated[dict[str, JsonValue], Field(max_length=50)]


def robot_of(name: str) -> RobotId:
    """Return the robot of a message's name for it."""
    team, _, number = name.partition(" ")
    return RobotId(Team(team), int(number))


class MoveBall(Settings):
    """Place the ball with a velocity; ``held`` while it is dragged."""

    do: Literal["ball"]
    x: _Metres
    y: _Metres
    vx: _MetresPerSecond = 0.0
    vy: _MetresPerSecond = 0.0
    held: bool = False


class MoveRobot(Settings):
    """Place a robot, in world coordinates; ``held`` while it is dragged."""

    do: Literal["robot"]
    robot: _Robot
    x: _Metres
    y: _Metres
    heading: float = Field(ge=-7, le=7)
    held: bool = False


class TakeOff(Settings):
    """Take a robot off the field."""

    do: Literal["off"]
    robot: _Robot


class GiveOrder(Settings):
    """Give an order as the referee."""

    do: Literal["order"]
    order: Order
    team: Team | None = None


class AskForm(Settings):
    """Request the parameters of a robot's play, or of a node of its tree."""

    do: Literal["form"]
    robot: _Robot
    path: str = Field("", max_length=2000)


class Play(Settings):
    """Let a robot, or with ``team`` all of its team but the goalkeeper, play something."""

    do: Literal["play"]
    robot: _Robot
    play: str = Field(max_length=400)
    params: _Parameters = Field(default_factory=dict)
    team: bool = False


class ChangeSkill(Settings):
    """Give a skill of a robot's tree other parameters."""

    do: Literal["skill"]
    robot: _Robot
    path: str = Field(max_length=2000)
    params: _Parameters


class Situation(Settings):
    """Make a scenario of the present situation."""

    do: Literal["situation"]


class Take(Settings):
    """Drive a robot in place of its tree."""

    do: Literal["take"]
    robot: _Robot


class Release(Settings):
    """Let the tree drive the robot again."""

    do: Literal["release"]


class Rest(Settings):
    """Stop the driven robot, for example because the page has lost the focus."""

    do: Literal["rest"]


_Share = Annotated[float, Field(ge=-1, le=1)]


class Drive(Settings):
    """The command of the driven robot; ``at`` is when the page sent it, by the page's clock [s].

    Velocity and turning rate are shares of what the robot can.
    """

    do: Literal["drive"]
    at: float = Field(ge=0, le=1e10)
    vx: _Share
    vy: _Share
    omega: _Share
    frame: Frames
    dribbler: bool = False
    kick: float = Field(0.0, ge=0, le=8)
    assist: bool = False


Act = (
    Pause
    | Step
    | Speed
    | Reset
    | Seek
    | MoveBall
    | MoveRobot
    | TakeOff
    | GiveOrder
    | AskForm
    | Play
    | ChangeSkill
    | Situation
    | Take
    | Release
    | Rest
    | Drive
)
"""Messages that act on the match, which only the steering viewer may send."""

Message = Act | Steer | Past | Layers

READER: TypeAdapter[Message] = TypeAdapter(Annotated[Message, Field(discriminator="do")])
"""Reads and checks a message."""


def read(data: str | bytes) -> Message | None:
    """Return the message, or None if it is invalid."""
    if len(data) > MOST_MESSAGE_BYTES:
        return None
    try:
        return READER.validate_json(data)
    except ValidationError:
        return None


FORMS: dict[str, type[Settings]] = {
    get_args(form.model_fields["do"].annotation)[0]: form for form in get_args(Message)
}
"""The forms of messages by what they do."""


class Allowance:
    """A rate limit: a bucket of messages that refills over time."""

    def __init__(self, now: float) -> None:
        self._left, self._at = BURST, now

    def take(self, now: float) -> bool:
        """Take one at ``now`` [s]; whether there was one."""
        self._left = min(BURST, self._left + RATE * (now - self._at))
        self._at = now
        if self._left < 1.0:
            return False
        self._left -= 1.0
        return True
