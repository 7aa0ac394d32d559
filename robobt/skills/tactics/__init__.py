"""The agreement of robots that play ``team_player``: tasks, places, passes and marks."""
