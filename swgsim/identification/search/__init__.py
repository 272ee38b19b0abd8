"""Candidates: screening of the library, regularities over speed and load, high orders, detection limits."""
