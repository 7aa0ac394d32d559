"""Conditions: leaves that only check something and command nothing."""
