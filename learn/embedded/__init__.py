"""Trained classifiers with their features as C for the microcontroller next to the gauges, or as ONNX for gateways."""
