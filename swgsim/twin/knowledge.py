"""What is known before the first recording of a gear: the nominal gear, the bench and the faults that may be."""

from dataclasses import dataclass, field, replace
from functools import cached_property

from swgsim.bench.scatter import Bench
from swgsim.dataset.plan import Plan
from swgsim.effects import Effect
from swgsim.gear.conditions import Conditions
from swgsim.gear.gear import Gear
from swgsim.identification.data.model import Model, Situation
from swgsim.identification.fit.priors import Declared
from swgsim.oracle.cells import Resolution
from swgsim.oracle.model import bench_of
from swgsim.twin.healthy_scatter import HealthyScatter
from swgsim.twin.parameters import parameters_of, start_of


@dataclass(frozen=True, eq=False)
class Knowledge:
    """The declared choices on which a twin rests; none of them is learned from recordings.

    Attributes
    ----------
    plan : Plan
        Its first gear is the nominal one. Bench, window, mesh, and the classes with their severities and operating
        points are those that are believed; its other gears are not used.
    resolution : Resolution
        Of Bayes' rule.
    further : tuple of str
        Parameters that units of a series share but may differ by here, such as b0 and mu of the friction
        (:data:`swgsim.twin.parameters.SHARED`).
    """

    plan: Plan
    resolution: Resolution = field(default_factory=Resolution)
    further: tuple[str, ...] = ()

    @property
    def nominal(self) -> Gear:
        """The gear of which every unit is one."""
        return self.plan.gears[0]

    @property
    def bench(self) -> Bench:
        """The statistics of the bench; raises a ValueError if the plan has none."""
        return bench_of(self.plan)

    @property
    def situations(self) -> list[Situation]:
        """The operating points without errors of the bench."""
        conditions = Conditions(temperature=self.bench.reference_temperature)
        return [Situation(point, conditions) for point in self.plan.grid.points]

    def plan_of(self, effects: tuple[Effect, ...]) -> Plan:
        """The plan for one unit, all effects of which are given: the bench draws no imperfections."""
        drawn = ("eccentricity", "cam_form", "gauge_position")
        bench = replace(self.bench, **dict.fromkeys(drawn, 0.0))
        return replace(self.plan, bench=bench, effects=effects)

    def scatter_of(self, model: Model) -> HealthyScatter:
        """How healthy recordings of a gear scatter."""
        return HealthyScatter.of(self.plan_of(model.effects), self.whole(model), self.resolution.draws)

    @cached_property
    def start(self) -> Model:
        """The model from which a fit begins, with the declared effects of the plan."""
        return start_of(self.nominal).plus(*self.plan.effects)

    @cached_property
    def at_start(self) -> HealthyScatter:
        """How healthy recordings scatter before anything is known of the gear."""
        return self.scatter_of(self.start)

    def parameters(self, structure: float = 0.0) -> dict[str, Declared]:
        """What may differ between units, with a spread of the factors of the structure."""
        return parameters_of(self.nominal, self.bench, structure, self.further)

    def whole(self, model: Model) -> Gear:
        """The gear of a model with the part of the friction that the fit leaves out (:func:`start_of`)."""
        return model.gear.with_transmission(b3=self.nominal.transmission.b3)
