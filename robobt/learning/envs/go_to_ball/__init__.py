"""Go-To-Ball: drive to the ball. A reward term is added in ``rewards.py``."""
