"""The referee: its settings, events, restarts, fouls and the state of the game."""
