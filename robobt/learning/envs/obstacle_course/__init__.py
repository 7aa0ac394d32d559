"""The obstacle challenge of 2025 for learners."""
