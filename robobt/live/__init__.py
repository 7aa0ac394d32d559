"""The page in the browser: one viewer for recordings and for matches while they are played."""
