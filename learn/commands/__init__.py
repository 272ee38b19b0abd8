"""Commands of more than one subpackage: ``train``, ``close-loop``, ``ui``, ``server``, ``upload``, ``benchmark``.

Each is one module with a function ``run``; pyproject.toml lists them. The subpackage exports nothing.
"""
