"""Contacts of robots, ball and walls over arrays, without pymunk."""
