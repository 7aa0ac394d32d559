"""Collecting shots from matches."""
