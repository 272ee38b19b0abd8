"""Effects in configuration: exact round trips, errors that list the choices, effects of users, data sets with them."""

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from chain_fixtures import small_plan
from hydra import compose, initialize_config_dir
from omegaconf import OmegaConf

from swgsim.dataset.simulate_cases import record
from swgsim.effects import EccentricWaveGenerator, Effect, ReducedDamping
from swgsim.effects.library import LIBRARY, SEARCHED, named
from swgsim.effects.one_gauge import ALL
from swgsim.effects.quantity import Role, quantities
from swgsim.effects.text import as_text, from_text, in_words, path_of
from swgsim.effects.thermal_output import ThermalOutput
from swgsim.jobs import settings

ROOT = Path(__file__).parents[2]
MINE = '''
from dataclasses import dataclass
from swgsim.effects.base import Effect
from swgsim.effects.quantity import size

@dataclass(frozen=True)
class Softening(Effect):
    """All gauges lose a share of their signal."""

    place = "gauge"
    share: float = size(unit="-", low=0, high=0.1, typical=0.01)
    note: str = ""

    def gauge(self, signals, scene):
        return signals * (1 - self.share)
'''


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """The import path of an effect from outside."""
    module = f"mine_{tmp_path.name.replace('-', '_')}"
    (tmp_path / f"{module}.py").write_text(MINE)
    monkeypatch.syspath_prepend(tmp_path)
    return f"{module}:Softening"


@cache
def composed(*overrides: str) -> dict[str, Any]:
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return OmegaConf.to_container(compose("generate", ["grid=small", *overrides]), resolve=True)


@pytest.mark.parametrize("name", LIBRARY)
def test_every_effect_comes_back_as_it_was(name: str) -> None:
    rng = np.random.default_rng(0)
    for share in rng.uniform(0, 1, 5):
        effect = LIBRARY[name](**{
            key: int(q.low) if q.role.value == "choice" else np.float64(q.low + share * (q.high - q.low))
            for key, q in quantities(LIBRARY[name]).items()
        })  # fmt: skip
        assert from_text(as_text([effect, effect]), "text") == (effect, effect)


@pytest.mark.parametrize("kind", SEARCHED)
def test_a_sentence_has_neither_code_nor_the_unit_of_a_share(kind: type[Effect]) -> None:
    declared = quantities(kind)
    effect = kind(**{name: q.typical if q.role is not Role.CHOICE else int(q.low) for name, q in declared.items()})
    assert "_" not in in_words(effect)
    assert "-)" not in in_words(effect)


def test_text_that_looks_like_a_number_stays_text(mine: str) -> None:
    kind = named(mine)
    for note in ("1e5", "-1e-5", "1.0", "true", "null", "a: b"):
        effect = kind(0.02, note)
        assert path_of(kind) == mine
        assert from_text(as_text([effect]), "text") == (effect,)


def test_numbers_may_be_written_as_everybody_writes_them() -> None:
    text = "effects: [{eccentric_wave_generator: {r: 1e-5, theta: -2E0}}, {reduced_damping: {b1_ratio: 1}}]"
    assert from_text(text, "text") == (EccentricWaveGenerator(1e-5, -2.0), ReducedDamping(1))


@pytest.mark.parametrize("path", sorted((ROOT / "conf" / "effect").glob("*.yaml")), ids=lambda path: path.stem)
def test_every_file_of_effects_is_a_choice_and_a_file(path: Path) -> None:
    effects = settings.effects(str(path))
    assert (effects == ()) == (path.stem == "none")
    assert settings.effects(composed(f"effect={path.stem}")["effects"]) == effects
    assert settings.plan(composed() | {"effects": str(path)}).effects == effects


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("[", "f.yaml is no YAML"),
        ("cam_form: {}", r"f.yaml holds no list of effects; it must look like 'effects: \["),
        ("effects: {cam_form: {}}", "f.yaml holds no list of effects"),
        ("effects: [cam_form]", "effect 1 is 'cam_form', must be one name with its parameters, such as"),
        ("effects: [{reduced_damping: {b1_ratio: 1}}, {a: {}, b: {}}]", "effect 2 is .* must be one name"),
        ("effects: [{cam: {}}]", "unknown effect 'cam'. The library has .* own needs its import path"),
        ("effects: [{ecentric_wave_generator: {}}]", r"Did you mean eccentric_wave_generator\? The library has"),
        ("effects: [{'.cam:Cam': {}}]", "unknown effect '.cam:Cam'. The library has"),
        ("effects: [{'cam:Cam': {}}]", "'cam:Cam' cannot be imported: No module.*is the folder of cam on PYTHONPATH"),
        ("effects: [{'json:JSONDecoder': {}}]", "'json:JSONDecoder' is no effect: it must be a class derived from"),
        ("effects: [{cam_form: 3}]", "parameters of cam_form are 3, must be a mapping; its parameters are n, an"),
        (
            "effects: [{cam_form: {m: 3}}]",
            r"unknown parameter 'm' of cam_form; its parameters are n, an integer from 3 to 8; "
            r"amplitude \[m\] from 0 to 2e-05; phase \[rad\]",
        ),
        ("effects: [{mains_hum: {hertz: 3}}]", r"its parameters are .* frequency \[Hz\], one of 50, 60, 100, 120"),
        ("effects: [{mains_hum: {amplitude: 0.001, frequency: 51}}]", "mains hum is 51, must be one of 50, 60"),
        ("effects: [{cam_form: {n: 3}}]", r"cam_form has no amplitude; its parameters are .* amplitude \[m\]"),
        ("effects: [{cam_form: }]", "cam_form has no n, amplitude; its parameters are"),
        (
            "effects: [{eccentric_wave_generator: {r: 1, theta: 0}}]",
            "r of eccentric wave generator is 1, must be a finite number from 0 to 0.00015",
        ),
    ],
)
def test_a_bad_text_is_answered_with_the_choices(text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        from_text(text, "f.yaml")


def test_what_nothing_can_import_is_not_written() -> None:
    class Local(Effect):
        """Of this function only."""

    with pytest.raises(ValueError, match="define it at the top of a module of its own"):
        as_text([Local()])


def test_without_effects_a_data_set_says_no_word_of_them() -> None:
    config = composed()
    assert "effect" not in settings.as_text(config)
    assert settings.as_text(config) == settings.as_text({key: v for key, v in config.items() if key != "effects"})


def test_a_data_set_remembers_its_effects_in_full_and_the_code_of_a_user(mine: str, tmp_path: Path) -> None:
    file = tmp_path / "effects.yaml"
    file.write_text(f"effects:\n- {mine}: {{share: 0.02}}\n- reduced_damping: {{b1_ratio: 0.8}}\n")
    said = yaml.safe_load(settings.as_text(composed(f"effects={file}")))
    assert said["effects"][1] == {"reduced_damping": {"b1_ratio": 0.8}}
    assert settings.plan(said).effects == settings.effects(str(file))
    assert list(said["code_of_effects"]) == [mine.partition(":")[0]]


@pytest.mark.slow
def test_every_recording_has_the_effects(mine: str) -> None:
    plan = small_plan()
    extended = small_plan(effects=(named(mine)(0.02),))
    cases = next(plan.blocks())[:8]
    before, after = (record(each, cases) for each in (plan, extended))
    np.testing.assert_allclose(after.signals, 0.98 * before.signals, rtol=1e-5)
    assert (after.table["efficiency"] == before.table["efficiency"]).all()
    random = small_plan(effects=(LIBRARY["mains_hum"](0.001),))
    hum = record(random, cases).signals - before.signals
    assert np.abs(np.corrcoef(hum[:, 1])[0, 1:]).min() < 0.9  # a phase of its own in every recording


def test_a_sentence_names_the_gauge() -> None:
    assert in_words(ThermalOutput(3, 2e-4)) == "thermal output of s3 (slope 0.0002 mV/V per K)"
    assert in_words(ThermalOutput(ALL, 2e-4)).startswith("thermal output of all gauges (")
