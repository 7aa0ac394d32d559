"""Addresses and ports of the league's programs."""

from __future__ import annotations

from ipaddress import IPv4Address
from typing import NamedTuple

from pydantic import BaseModel, ConfigDict, Field

VISION_GROUP = "224.5.23.2"
REFEREE_GROUP = "224.5.23.1"


class Endpoint(NamedTuple):
    """An IPv4 address and a UDP port."""

    address: str
    port: int

    def __str__(self) -> str:
        return f"{self.address}:{self.port}"


class Endpoints(BaseModel):
    """Who is reached where. The defaults are those of the league's simulators.

    The ports of grSim and the simulation protocol are those of one host; port 0
    takes a free one where something is served.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    vision: Endpoint = Field(Endpoint(VISION_GROUP, 10020), description="SSL-Vision; 10006 on a real field")
    tracker: Endpoint = Field(Endpoint(VISION_GROUP, 10010), description="tracked frames")
    referee: Endpoint = Field(Endpoint(REFEREE_GROUP, 10003), description="game controller")
    grsim: int = Field(20011, ge=0, le=65535, description="grSim's commands and replacements")
    blue_status: int = Field(30011, ge=0, le=65535, description="grSim's status of blue robots")
    yellow_status: int = Field(30012, ge=0, le=65535, description="grSim's status of yellow robots")
    control: int = Field(10300, ge=0, le=65535, description="teleport and configuration")
    blue: int = Field(10301, ge=0, le=65535, description="control of blue robots")
    yellow: int = Field(10302, ge=0, le=65535, description="control of yellow robots")


def parse_endpoint(text: str) -> Endpoint:
    """An address like ``224.5.23.2:10006``.

    Raises:
        ValueError: it is none.
    """
    host, colon, port = text.rpartition(":")
    try:
        address = str(IPv4Address(host))
        number = int(port)
    except ValueError:
        number = -1
    if not colon or not 0 <= number <= 65535:
        raise ValueError(f"{text!r} is no address like 224.5.23.2:10006")
    return Endpoint(address, number)
