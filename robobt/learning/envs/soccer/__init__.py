"""Tasks with several robots, learned and scripted. Add a reward term in ``rewards.py``."""
