"""The referee: its settings, what it reports, restarts, fouls and the state of the game."""
