"""Measurements of speed and of what learned skills are worth: ``python -m benchmarks NAME``."""
