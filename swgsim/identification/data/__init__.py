"""Measurements and predictions as order lines: features, noise, sessions, zero of the angle."""
