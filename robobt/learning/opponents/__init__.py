"""Compiled opponents for training in many arenas: the decisions of plays, without their trees.

A new opponent takes one file, here or of your own: any code that fills in commands in a task's ``oppose``
(docs/own_tasks.md). The opponents here drive by :mod:`robobt.learning.opponents.straight` or by the compiled
code of skills, and see arenas through :mod:`robobt.learning.opponents.sides`.
"""
