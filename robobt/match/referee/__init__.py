"""The referee and the end conditions of a trial."""
