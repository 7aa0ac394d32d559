"""Who does what, and where to wait for the ball."""
