"""Goalkeepers as recorded shots show them: what they can do, and how likely each of them saves a shot."""
