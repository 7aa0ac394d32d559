"""Game events: between the league's messages and those of the referee.

A message is one of many kinds whose fields are named alike, so they are converted by name. Positions are
in metres there too; ours are those of a field on which blue defends -x.
"""

from __future__ import annotations

from math import isfinite

from google.protobuf.descriptor import FieldDescriptor

from robobt.config.errors import one_line
from robobt.league.wire.messages import GameEvent, Message
from robobt.league.wire.packets import MAX_ROBOT_NUMBER, MICROSECONDS_PER_S, on_field
from robobt.league.wire.simulation import TEAMS
from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.world.game import Team
from robobt.world.state import RobotId

_EVENT_TEAM_NUMBERS = {team: number for number, team in TEAMS.items()}

_OFFENDER = ("by_bot", "violator", "kicking_bot")
"""Names in messages of the robot that caused an event."""

_TIMES = frozenset({"last_touch_by_team"})
"""Fields that are moments, in microseconds."""


def write_event(event: RefereeEvent, epoch: float, origin: str) -> GameEvent:
    """Return the message of an event; details that the league's message lacks are left out.

    Args:
        event: what happened.
        epoch: Unix time at which the simulated time was 0 [s].
        origin: who saw it.
    """
    message = GameEvent(type=event.kind.name, origin=[origin])
    message.created_timestamp = round((epoch + event.time) * MICROSECONDS_PER_S)
    body: Message = getattr(message, event.kind.value)
    body.SetInParent()
    names = body.DESCRIPTOR.fields_by_name
    values: dict[str, Detail] = {"location": (event.x, event.y)}
    if event.robot is not None:
        values |= dict.fromkeys(_OFFENDER, event.robot.number)
    if "by_team" in names:
        # Required in the message even if no robot caused it.
        body.by_team = 0 if event.team is None else _EVENT_TEAM_NUMBERS[event.team]
    for name, value in (values | dict(event.details)).items():
        if name not in names or value is None:
            continue
        if isinstance(value, tuple):
            point = getattr(body, name)
            point.x, point.y = value
        elif name in _TIMES and isinstance(value, float):
            setattr(body, name, round((epoch + value) * MICROSECONDS_PER_S))
        else:
            setattr(body, name, _EVENT_TEAM_NUMBERS[value] if isinstance(value, Team) else value)
    return message


def read_event(message: GameEvent, epoch: float, now: float) -> RefereeEvent | None:
    """Return the event of a message; None for a kind that is outdated or not known yet.

    What is missing or impossible is left out.

    Args:
        message: the league's event.
        epoch: Unix time at which the simulated time was 0 [s].
        now: the simulated time, for an event that does not say when it happened [s].
    """
    kind = _EVENT_KINDS.get(int(message.type))
    if kind is None:
        return None
    values = _fields(getattr(message, kind.value), epoch)
    team, place = values.pop("by_team", None), values.pop("location", None)
    # A dribble has no location of its own: what follows is where it began.
    place = values.get("start") if place is None else place
    x, y = place if isinstance(place, tuple) else (0.0, 0.0)
    number = next((values.pop(name) for name in _OFFENDER if name in values), None)
    robot = None
    # A robot may have scored an own goal.
    kicking = values.get("kicking_team", team)
    if isinstance(kicking, Team) and isinstance(number, int) and 0 <= number <= MAX_ROBOT_NUMBER:
        robot = RobotId(kicking, number)
    told = message.HasField("created_timestamp")
    time = message.created_timestamp / MICROSECONDS_PER_S - epoch if told else now
    return RefereeEvent(time, kind, team if isinstance(team, Team) else None, robot, x, y, values)


_EVENT_KINDS = {GameEvent.Type.Value(kind.name): kind for kind in EventKind}


def _fields(body: Message, epoch: float) -> dict[str, Detail]:
    """Return the fields that are set, by name."""
    found: dict[str, Detail] = {}
    for field, value in body.ListFields():
        name: str = field.name
        if name == "caused_game_events":
            found[name] = ", ".join(GameEvent.Type.Name(event.type).lower() for event in value[:16])
        elif field.type == FieldDescriptor.TYPE_MESSAGE:
            if on_field(value.x, value.y):
                found[name] = (value.x, value.y)
        elif field.type == FieldDescriptor.TYPE_ENUM:
            found[name] = TEAMS.get(value)
        elif field.type == FieldDescriptor.TYPE_STRING:
            # What is no UTF-8 is left as bytes.
            found[name] = one_line(value if isinstance(value, str) else value.decode(errors="replace"))
        elif name in _TIMES:
            found[name] = value / MICROSECONDS_PER_S - epoch
        elif isfinite(value):
            found[name] = value
    return found
