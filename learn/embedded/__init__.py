"""Trained classifiers with their features as C for the microcontroller beside the gauges, or as ONNX for gateways."""
