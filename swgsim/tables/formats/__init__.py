"""Readers of one format each: wanted columns of a file, as arrays of numbers. Objects and code are never read."""
