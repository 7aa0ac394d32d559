"""Shoot-Towards-Goal: turn with the ball and kick it. A reward term is added in ``rewards.py``."""
