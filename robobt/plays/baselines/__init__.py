"""Frozen plays to measure new plays against; a test pins their decisions."""
