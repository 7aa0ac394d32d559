"""Opponents to train against, compiled for many arenas: what plays decide, without their trees.

A new one takes one file, one's own as well as one here: anything that fills commands in a task's ``oppose``
(docs/own_tasks.md). Those here drive by :mod:`robobt.learning.opponents.straight` or by the laws of skills,
on arenas as :mod:`robobt.learning.opponents.sides` shows them.
"""
