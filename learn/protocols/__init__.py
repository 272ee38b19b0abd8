"""Splits into training and test by gear, operating point or fault size, and levels of target information."""

import lazy_loader

# Names are imported at first use, so that jobs without networks do not load PyTorch.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
