"""The league's network protocols: a world over SSL-Vision and commands, our simulator served to others."""

from robobt.league.estimate.filter import VisionFilter
from robobt.league.factory import LeagueFactory, parse_address
from robobt.league.log.files import LogRecord, LogWriter, read_log
from robobt.league.log.world import LogWorld
from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import Endpoint, Endpoints
from robobt.league.world import Connection, LeagueError, LeagueWorld

__all__ = [
    "Connection",
    "Endpoint",
    "Endpoints",
    "LeagueError",
    "LeagueFactory",
    "LeagueWorld",
    "LogRecord",
    "LogWorld",
    "LogWriter",
    "ServedField",
    "SimServer",
    "VisionFilter",
    "parse_address",
    "read_log",
]
