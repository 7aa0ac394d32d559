"""How a match begins if not by a kick-off; drills begin with the restart to practise."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robobt.match.referee.restarts import (
    LINE_GAP,
    PLACEMENT_COMMANDS,
    Resumption,
    drop_ball,
    free_kick,
    kickoff,
    penalty,
)
from robobt.match.referee.settings import RefereeSettings
from robobt.world.field import FieldGeometry
from robobt.world.game import RefereeCommand, Stage
from robobt.world.geometry import Point
from robobt.world.state import Frame


@dataclass(slots=True, frozen=True)
class Opening:
    """The first stage of a match, its first command and the restart after it."""

    stage: Stage
    command: RefereeCommand
    resumption: Resumption


def opening_of(
    settings: RefereeSettings, field: FieldGeometry, frame: Frame, generator: np.random.Generator
) -> Opening:
    """Return the opening of a match from its first frame; ``generator`` draws a random spot."""
    team, ball = settings.opening_team, frame.ball.position
    if settings.opening == "force_start":
        return Opening(Stage.NORMAL_FIRST_HALF, RefereeCommand.FORCE_START, drop_ball(field, *ball))
    if settings.opening == "free_kick":
        kick = free_kick(field, team, *_spot(settings, field, ball, generator))
        return Opening(Stage.NORMAL_FIRST_HALF, RefereeCommand.STOP, kick)
    if settings.opening == "ball_placement":
        kick = free_kick(field, team, *_spot(settings, field, ball, generator))
        return Opening(Stage.NORMAL_FIRST_HALF, PLACEMENT_COMMANDS[team], kick)
    if settings.opening == "penalty":
        return Opening(Stage.NORMAL_FIRST_HALF, RefereeCommand.STOP, penalty(field, team))
    if settings.opening == "shoot_out":
        return Opening(Stage.PENALTY_SHOOTOUT, RefereeCommand.STOP, penalty(field, team))
    return Opening(Stage.NORMAL_FIRST_HALF_PRE, RefereeCommand.STOP, kickoff(team))


def _spot(
    settings: RefereeSettings, field: FieldGeometry, ball: Point, generator: np.random.Generator
) -> Point:
    spot = settings.opening_spot
    if spot is None:
        return ball
    if spot == "random":
        x, y = generator.uniform(-1.0, 1.0, 2)
        return (float(x) * (field.half_length - LINE_GAP), float(y) * (field.half_width - LINE_GAP))
    return spot
