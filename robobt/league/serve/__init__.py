"""The simulator, served to other teams' programs."""
