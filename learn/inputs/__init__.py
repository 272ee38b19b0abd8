"""Inputs of classifiers: features (Selections 1 to 3), harmonics, raw, differenced and residual signals.

Imports ``swgsim.common`` and ``swgsim.storage``.
"""

import lazy_loader

# A name is imported when it is used, so that a sweep of forests does not wait for PyTorch.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
