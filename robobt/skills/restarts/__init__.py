"""Positions and conduct while the ball is out of play."""
