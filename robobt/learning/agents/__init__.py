"""Learning algorithms, without environments."""
