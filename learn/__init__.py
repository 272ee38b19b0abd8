"""Classifiers for the condition of strain wave gears: inputs, methods, protocols, transfer and their evaluation.

``import learn`` is the public interface:

- :func:`load`: a data set of ``swg generate`` as features and a table of facts;
- :func:`classifier`: an untrained classifier by its name in ``conf/classifier``;
- :func:`evaluate`: scores of a classifier, by name or of one's own, under a protocol such as "leave_one_gear_out";
- :func:`transfer`: the same for gears never seen, with a few labelled recordings of each.

Sweeps over many choices, with every job kept in MLflow, are the command ``swg train``.

Examples
--------
>>> import learn
>>> data = learn.load("data/small-clean.h5", features="selection_3")  # doctest: +SKIP
>>> learn.evaluate(data, "rf", "leave_one_gear_out")  # doctest: +SKIP
<Scores rf, leave one gear out: 99.8 % of 432 tested recordings right>
"""

import lazy_loader

# A name is imported when it is used, so that nobody waits for PyTorch who does not need it.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
