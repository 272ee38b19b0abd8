"""Closing the loop: find the residual between model and measurement, and the physical effect that explains it."""
