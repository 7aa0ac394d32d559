"""Tasks of several robots, learned and scripted. A reward term is added in ``rewards.py``."""
