"""The league's network protocols: a world over SSL-Vision and commands, our simulator served to others."""

from robobt.league.endpoints import Endpoint, Endpoints
from robobt.league.factory import LeagueFactory, parse_address
from robobt.league.filter import VisionFilter
from robobt.league.log_world import LogWorld
from robobt.league.logs import LogRecord, LogWriter, read_log
from robobt.league.served_field import ServedField
from robobt.league.server import SimServer
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
