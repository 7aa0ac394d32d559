"""Plays for the league's technical challenges."""
