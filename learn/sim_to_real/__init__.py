"""Classifiers trained on a model of a gear and tested on its bench, where an effect acts that the model lacks.

Before and after the loop was closed on healthy recordings, and with a model that knew the effect from the start. The
command ``swg sim-to-real`` is in ``learn.commands``; the subpackage exports nothing.
"""
