"""Keeping the opponents from scoring."""
