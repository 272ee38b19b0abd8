"""Commands that need more than one room: ``train``, ``close-loop``, ``ui``, ``server``, ``upload``, ``benchmark``.

Each is one module with a function ``run``; pyproject.toml lists them. The room exports nothing.
"""
