"""Roles in the team, and places to wait for the ball."""
