"""Checks of a model's content before torch or onnxruntime reads it; anything not allowed is a ModelError."""
