"""Score-On-Goalkeeper: get the ball and score on a goalkeeper. A reward term is added in ``rewards.py``."""
