"""Scenario files: who plays what where, until when."""
