"""Choosing where to shoot or pass."""
