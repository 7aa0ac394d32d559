"""Addresses are checked when they are read."""

from __future__ import annotations

import pytest

from robobt.league.wire.endpoints import parse_endpoint


@pytest.mark.parametrize("text", ["here", "224.5.23.2", "224.5.23.2:", "224.5.23.2:70000", "localhost:1"])
def test_an_endpoint_that_is_none_is_one_plain_error(text: str) -> None:
    with pytest.raises(ValueError, match=r"is not an address like 224\.5\.23\.2:10006"):
        parse_endpoint(text)
