"""From configuration (``conf/``) to objects, data sets and virtual recordings.

Imports ``dataset`` and rooms below it.
"""
