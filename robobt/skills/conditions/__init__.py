"""Conditions: leaves that look and decide nothing else."""
