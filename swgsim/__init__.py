"""Simulation and identification of strain wave gears whose flex spline carries strain gauges.

``import swgsim as swg`` is the public interface:

- :class:`Gear`, :class:`OperatingPoint`, :mod:`effects`: what is simulated. ``Gear.load("mine.yaml")`` reads a gear.
- :func:`simulate`: one run of the chain; the result plots itself and becomes a table or a recording.
- :func:`read_recordings`: a folder of measurements. :func:`recordings_of`: the logs of a robot joint.
- :func:`draft_map`: a first map of files in other formats, by looking at them; it is then corrected by hand.
- :func:`commission`, :func:`identify`: what the healthy gear is like, and which physical effect a model of it lacks.
  ``unit.save("gear7.unit.h5")`` and ``Unit.load("gear7.unit.h5")`` keep what was learned.
- :func:`diagnose`: whether a gear has a fault, which one, how large and where, from recordings and healthy ones before.
- :func:`record`, :func:`generate`: recordings of a virtual test bench, and labelled data sets for :mod:`learn`.
- :class:`Run`, :func:`simulate_runs`: many runs at once, for studies of one's own.

Everything else may change. Subpackages and what they import: docs/architecture.md.

Examples
--------
>>> import swgsim as swg
>>> point = swg.OperatingPoint(n_in_rpm=2000, T_out=39)
>>> healthy = swg.simulate(swg.Gear(), point)
>>> cracked = swg.simulate(swg.Gear(), point, swg.effects.RootToothCrack(0.03, theta=1.0))
>>> bool(abs(cracked.signals - healthy.signals).max() > 0)
True
"""

import lazy_loader

# A name is imported when it is used: reading the version takes no second.
__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
