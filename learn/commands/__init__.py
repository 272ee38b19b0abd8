"""Commands that need more than one room: ``train``, ``close-loop``, ``ui``, ``server``, ``upload``, ``benchmark``.

Imports every room of ``learn`` and the jobs of ``swgsim``.
"""
