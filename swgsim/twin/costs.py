"""What to do with a unit: the decision of the least expected cost, by the probabilities of its classes."""

from collections.abc import Mapping

from swgsim.common.checks import require, require_known
from swgsim.dataset.faults import FAULTS
from swgsim.storage.labelled_signals import CLASSES

Costs = Mapping[str, Mapping[str, float]]

# Decision to class to cost, in prices of a gear. To take a unit out and apart costs a tenth of a gear, and a fault that
# is then seen costs the gear as well; a fault that is left costs ten, such as the standstill of a line. These figures
# are examples, which a workshop replaces by its own.
GEAR, INSPECTION, DAMAGE = 1.0, 0.1, 10.0
COSTS: Costs = {
    "leave": {"healthy": 0.0, **dict.fromkeys(FAULTS, DAMAGE)},
    "inspect": {"healthy": INSPECTION, **dict.fromkeys(FAULTS, INSPECTION + GEAR)},
    "replace": dict.fromkeys(CLASSES, GEAR),
}


def costs_with(changed: Costs) -> Costs:
    """The costs, with some that differ from :data:`COSTS`.

    >>> costs_with({"leave": {"reduced_damping": 2.0}})["leave"]["reduced_damping"]
    2.0

    Raises
    ------
    ValueError
        If a decision or a class is unknown, or a cost is below 0.
    """
    require_known("decisions of the costs", changed, COSTS)
    for decision, of_class in changed.items():
        require_known(f"classes of the costs of {decision}", of_class, CLASSES)
        for label, cost in of_class.items():
            require(f"the costs of {decision}", label, cost, low=0, high=1e12)
    return {decision: {**of_class, **changed.get(decision, {})} for decision, of_class in COSTS.items()}


def expected(costs: Costs, probabilities: Mapping[str, float]) -> dict[str, float]:
    """Expected cost of every decision, the cheapest first; of equal ones, the one that changes less.

    >>> expected(COSTS, {"healthy": 0.95, "root_tooth_crack": 0.05})
    {'inspect': 0.15, 'leave': 0.5, 'replace': 1.0}
    """
    means = {
        decision: round(sum(p * of_class[label] for label, p in probabilities.items()), 12)
        for decision, of_class in costs.items()
    }
    return dict(sorted(means.items(), key=lambda each: each[1]))
