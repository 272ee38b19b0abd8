"""The paper's Tables VII to X and its claims compared with our results: report/index.html."""

import lazy_loader

# A name is imported when it is used, so that a sweep of forests does not wait for PyTorch.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
