"""Configuration meets code: ``conf/`` becomes objects, and data sets and virtual recordings are made of them.

Imports ``dataset`` and rooms below it.
"""
