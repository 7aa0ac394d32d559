"""Getting the ball, keeping it and kicking it."""
