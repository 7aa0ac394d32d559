"""What a model may consist of, seen before torch or onnxruntime see it; anything else is a ModelError."""
