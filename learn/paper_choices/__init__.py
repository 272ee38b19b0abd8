"""Choices that the paper leaves open, fitted to its tables: what its chain has that ours lacks.

Imports ``paper`` and subpackages below it.
"""
