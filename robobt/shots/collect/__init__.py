"""Collecting shots from matches."""

from robobt.shots.collect.collect import Collected, CollectionError, collect_shots
from robobt.shots.collect.plan import CollectionSettings

__all__ = ["Collected", "CollectionError", "CollectionSettings", "collect_shots"]
