"""The page in the browser: one viewer for recordings and for matches while they are played."""

from robobt.config.extras import need

need("record", "pyarrow")
