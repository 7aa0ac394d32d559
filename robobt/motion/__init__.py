"""Driving without trees: trajectories, path planning, the ball's motion, the kick approach."""
