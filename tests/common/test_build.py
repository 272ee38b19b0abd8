"""Objects with other values: as dataclasses make them, checks included."""

from dataclasses import replace

import pytest

from swgsim.common.build import replaced
from swgsim.gear.gear import Gear, Transmission


def test_it_is_the_replacement_of_dataclasses() -> None:
    for one, changes in ((Transmission(), {"b1": 0.3, "theta_b": 1.0}), (Gear(), {"number": 7}), (Gear(), {})):
        assert replaced(one, **changes) == replace(one, **changes)
        assert hash(replaced(one, **changes)) == hash(replace(one, **changes))


def test_wrong_values_and_names_are_refused() -> None:
    with pytest.raises(ValueError, match="b1 of the transmission is -1"):
        replaced(Transmission(), b1=-1.0)
    with pytest.raises(TypeError, match="Transmission has no b9"):
        replaced(Transmission(), b9=1.0)
