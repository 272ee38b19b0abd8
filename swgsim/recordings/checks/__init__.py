"""Checks for defects of a test bench in its recordings; they report defects and never correct them."""
