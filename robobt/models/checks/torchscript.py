"""The look at a TorchScript archive before torch sees it."""

from __future__ import annotations

from collections.abc import Mapping

from robobt.models.checks.pickles import check_pickles
from robobt.models.checks.source import read_sources
from robobt.models.file import ModelError


def checked_members(members: Mapping[str, bytes]) -> dict[str, bytes]:
    """Check that an archive holds a network, and return what torch may read of it.

    Loading it then runs nothing: its code has functions and modules of plain operations, and
    its pickles make modules, tensors and plain values, as its code describes them.

    Raises:
        ModelError: it holds something that no network needs, or is damaged.
    """
    sources = read_sources({name: content for name, content in members.items() if name.startswith("code/")})
    check_pickles(members, sources)
    if members.get("byteorder", b"little") != b"little":
        raise ModelError("was written by a machine with another order of bytes")
    return {**members, **sources.texts}
