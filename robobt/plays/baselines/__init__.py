"""Plays that stay as they were, to measure new ones against; a test holds their decisions fast."""
