"""Trained classifiers with their features as C for the microcontroller next to the gauges, or as ONNX for gateways.

The commands ``swg embedded`` and ``swg export`` are ``report`` and ``export_job``; the subpackage exports nothing.
"""
