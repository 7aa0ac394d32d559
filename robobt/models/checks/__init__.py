"""What a model may consist of, looked over before torch or onnxruntime see it."""
