"""Inputs of classifiers: features of Table III, harmonics, residual lines, and signals."""

import lazy_loader

# Names are imported at first use, so that jobs without networks do not load PyTorch.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
