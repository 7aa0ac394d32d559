"""Policies and predictors at run time: card, file format, checks, loading, export."""
