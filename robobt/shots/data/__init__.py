"""The table of shots and its files."""
