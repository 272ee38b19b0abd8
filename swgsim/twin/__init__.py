"""The twin of a gear: the simulation chain fitted to its healthy references, on which Bayes' rule diagnoses faults.

It needs no other gear, no label and no recorded fault. Bayes' rule is that of ``oracle``, which knows the true gear;
the fit is that of ``identification``. ``diagnose`` is for folders of recordings, ``Twin`` for data sets.
"""

from swgsim.twin.fitted_gear import FittedGear, fit_gear
from swgsim.twin.knowledge import Knowledge
from swgsim.twin.references import References
from swgsim.twin.twin import Twin
from swgsim.twin.unit_diagnosis import Diagnosis, diagnose

__all__ = ["Diagnosis", "FittedGear", "Knowledge", "References", "Twin", "diagnose", "fit_gear"]
