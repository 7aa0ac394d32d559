"""What robots that play ``team_player`` agree on: tasks, places, passes and marks."""
