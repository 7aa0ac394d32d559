"""Scenario files: robots, plays, starts and end conditions."""
