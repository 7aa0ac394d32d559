"""Addresses and ports of the league's programs."""

from __future__ import annotations

from ipaddress import IPv4Address
from typing import Annotated, NamedTuple

from pydantic import AfterValidator, BeforeValidator, Field

from robobt.config.validation import Settings

VISION_GROUP = "224.5.23.2"
REFEREE_GROUP = "224.5.23.1"


class Endpoint(NamedTuple):
    """An IPv4 address and a UDP port."""

    address: str
    port: int

    def __str__(self) -> str:
        return f"{self.address}:{self.port}"


def parse_endpoint(text: str) -> Endpoint:
    """Parse an address like ``224.5.23.2:10006``.

    Raises:
        ValueError: the text has another form.
    """
    host, colon, port = text.rpartition(":")
    try:
        address = str(IPv4Address(host))
        number = int(port)
    except ValueError:
        number = -1
    if not colon or not 0 <= number <= 65535:
        raise ValueError(f"{text!r} is not an address like 224.5.23.2:10006")
    return Endpoint(address, number)


def _ipv4(value: str) -> str:
    try:
        return str(IPv4Address(value))
    except ValueError:
        raise ValueError(f"{value!r} is not an IPv4 address like 192.168.1.5") from None


HostAddress = Annotated[str, AfterValidator(_ipv4)]
"""An IPv4 address as text."""


_Address = Annotated[
    Endpoint, BeforeValidator(lambda value: parse_endpoint(value) if isinstance(value, str) else value)
]
_Port = Annotated[int, Field(ge=0, le=65535)]


class Endpoints(Settings):
    """Addresses and ports of a field's programs. The defaults are those of the league's simulators.

    Multicast addresses may be given as text, "224.5.23.2:10006". The ports of grSim
    and the simulation protocol belong to one host; a server picks a free port for 0.
    """

    vision: _Address = Field(Endpoint(VISION_GROUP, 10020), description="SSL-Vision; 10006 on a real field")
    tracker: _Address = Field(Endpoint(VISION_GROUP, 10010), description="tracked frames")
    referee: _Address = Field(Endpoint(REFEREE_GROUP, 10003), description="game controller")
    grsim: _Port = Field(20011, description="grSim's commands and replacements")
    blue_status: _Port = Field(30011, description="grSim's status of blue robots")
    yellow_status: _Port = Field(30012, description="grSim's status of yellow robots")
    control: _Port = Field(10300, description="teleports and configuration")
    blue: _Port = Field(10301, description="control of blue robots")
    yellow: _Port = Field(10302, description="control of yellow robots")
