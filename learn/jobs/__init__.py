"""Configuration meets code: one job trains and judges one choice; a sweep keeps every job as a run.

Imports all rooms of ``learn`` but the reports and ``embedded``.
"""
