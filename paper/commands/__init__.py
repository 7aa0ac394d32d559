"""The commands of ``python -m paper``: each parses its options, makes a table and prints it."""
