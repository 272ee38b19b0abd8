"""What every subpackage uses: checked input, whole files, seeds, number formats, page style, engines for many tasks."""

import lazy_loader

# A name is imported when it is used, so that no command waits for Matplotlib and SciPy before it reads its choices.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
