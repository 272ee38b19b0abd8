"""Covariances of recordings: noise, scatter between sessions, errors of the influence map, kept as low-rank factors."""
