"""Collecting shots from matches."""

from robobt.shots.collect.collect import Collected as Collected
from robobt.shots.collect.collect import CollectionError as CollectionError
from robobt.shots.collect.collect import collect_shots as collect_shots
from robobt.shots.collect.plan import CollectionSettings as CollectionSettings
