"""Contacts of robots, ball and walls over arrays, where pymunk is not asked."""
