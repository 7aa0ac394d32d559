"""Opponents to train against, compiled for many arenas: what plays decide, without their trees."""
