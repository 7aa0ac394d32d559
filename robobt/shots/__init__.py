"""Shots at the goal: their data, how they are collected, and predictors that learn from them."""
