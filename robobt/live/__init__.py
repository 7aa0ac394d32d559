"""The page in the browser: one viewer for recordings and for matches while they are played."""

from typing import TYPE_CHECKING

from robobt.config.extras import need
from robobt.config.lazy import lazily

need("record", "pyarrow")

_HOMES = {
    "LOOK": "session",
    "Live": "session",
    "Server": "server",
}

if TYPE_CHECKING:
    from robobt.live.server import Server as Server
    from robobt.live.session import LOOK as LOOK
    from robobt.live.session import Live as Live
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES, needs=("live", "pyarrow", "websockets"))
