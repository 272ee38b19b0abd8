"""Checks for defects that a test bench leaves in its recordings: they are reported, never silently corrected."""
