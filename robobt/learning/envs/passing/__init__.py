"""The passing challenge of 2025 for learners."""
