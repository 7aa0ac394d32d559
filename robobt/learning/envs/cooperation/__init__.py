"""The cooperation challenge of 2026 for learners."""
