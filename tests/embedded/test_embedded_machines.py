"""Programs on this machine and on emulated microcontrollers, with a method of a few lines."""

from pathlib import Path

import numpy as np
import pytest

from learn.embedded.machines import CORTEX_M4, CORTEX_M7, HOST, HOST_SANITIZED, Machine, build, missing, require_tools
from learn.embedded.running import PARTS, decide
from learn.embedded.sizes import sizes

# What the bench knows of a method, and no more.
HEADER = """
#include <stdbool.h>
#include <stdint.h>
#define SWG_GAUGES 5
#define SWG_COLUMNS 1
#define SWG_CLASSES 2
typedef struct { float n_in, T_out, efficiency, temperature; } swg_operation;
typedef struct { int32_t count; float sum; } swg_window;
bool swg_push(swg_window *window, const swg_operation *operation, const float sample[SWG_GAUGES]);
int swg_decide(const swg_window *window, const swg_operation *operation, float probability[SWG_CLASSES]);
void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS]);
void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES]);
"""
FRONT = """
#include <math.h>
#include "swg.h"
enum { SAMPLES = 20, NO_DECISION = -2 };
bool swg_push(swg_window *window, const swg_operation *operation, const float sample[SWG_GAUGES])
{
    (void)operation;
    if (window->count == SAMPLES)
        *window = (swg_window){0, 0};
    window->sum += sample[0];
    return ++window->count == SAMPLES;
}
int swg_decide(const swg_window *window, const swg_operation *operation, float probability[SWG_CLASSES])
{
    float row[SWG_COLUMNS];
    if (window->count < SAMPLES || isnan(window->sum))
        return NO_DECISION;
    swg_features(window, operation, row);
    swg_classify(row, probability);
    return probability[1] > probability[0];
}
void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS])
{
    row[0] = operation->efficiency * window->sum / (float)window->count;
}
"""
CLASSIFIER = """
#include <math.h>
#include "swg.h"
void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES])
{
    volatile unsigned char used[STACK];
    for (int i = 0; i < STACK; i++)
        used[i] = 1;
    for (volatile int i = 0; i < ROUNDS; i++)
        continue;
    probability[1] = 1 / (1 + expf(-row[0]));
    probability[0] = used[0] - probability[1];
}
"""
MACHINES = [HOST, HOST_SANITIZED, CORTEX_M4, CORTEX_M7]


def needs(machine: Machine) -> None:
    if missing(machine):
        pytest.skip(f"{machine.name} needs {missing(machine)}: run scripts/install_arm.sh")


def method(folder: Path, *, rounds: int = 1, stack: int = 4, classifier: str = CLASSIFIER) -> Path:
    """An exported method whose class is the sign of the mean of gauge 0; work and stack of its classifier are given."""
    folder.mkdir()
    (folder / "swg.h").write_text(HEADER)
    (folder / "front.c").write_text(FRONT)
    (folder / "tree.c").write_text(f"#define ROUNDS {rounds}\n#define STACK {stack}\n{classifier}")
    return folder


def recordings(count: int = 8) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(1)
    signals = rng.normal(size=(count, 5, 25)).astype(np.float32)
    return signals, rng.uniform(0.5, 1, (count, 4)).astype(np.float32)


def counted(program: Path, machine: Machine) -> tuple[dict[str, np.ndarray], int]:
    said = decide(program, machine, *recordings(), counted=True)
    assert said.instructions is not None
    assert said.stack is not None
    return said.instructions, said.stack


@pytest.mark.parametrize("machine", MACHINES, ids=lambda machine: machine.name)
def test_decisions_are_those_of_the_formula(machine: Machine, tmp_path: Path) -> None:
    needs(machine)
    signals, operations = recordings()
    signals[3, 0, 7] = np.nan
    said = decide(build(method(tmp_path / "c"), machine, tmp_path / "out"), machine, signals, operations)
    score = operations[:, 2] * signals[:, 0, :20].mean(axis=1)
    expected = np.where(np.isnan(score), -2, score > 0)
    positive = np.where(np.isnan(score), 0, 1 / (1 + np.exp(-score)))
    assert said.results.tolist() == expected.tolist()
    np.testing.assert_allclose(said.probabilities[:, 1], positive, atol=1e-6)
    assert (said.instructions, said.stack) == (None, None)


def test_a_recording_that_is_too_short_leaves_nothing_to_the_next(tmp_path: Path) -> None:
    needs(HOST)
    program = build(method(tmp_path / "c"), HOST, tmp_path / "out")
    signals, operations = recordings(3)
    assert decide(program, HOST, signals[:, :, :19], operations).results.tolist() == [-2, -2, -2]


def test_instructions_repeat_and_grow_with_the_work(tmp_path: Path) -> None:
    needs(CORTEX_M4)
    classify = []
    for rounds in (1, 1001, 2001):
        program = build(method(tmp_path / str(rounds), rounds=rounds), CORTEX_M4, tmp_path / f"out{rounds}")
        first, second = (counted(program, CORTEX_M4)[0] for _ in range(2))
        assert all(np.array_equal(first[part], second[part]) for part in PARTS)
        classify.append(first["classify"])
    of_thousand = np.diff(classify, axis=0)
    assert np.array_equal(of_thousand[0], of_thousand[1])  # to the instruction
    assert (of_thousand % 1000 == 0).all()
    assert 3000 <= of_thousand[0, 0] <= 8000


def test_parts_add_up(tmp_path: Path) -> None:
    needs(CORTEX_M7)
    parts, _ = counted(build(method(tmp_path / "c", rounds=10_000), CORTEX_M7, tmp_path / "out"), CORTEX_M7)
    between = parts["decide"] - parts["features"] - parts["classify"]
    assert (parts["classify"] > 30_000).all()
    assert between.min() > 0
    assert between.max() < 60
    assert (parts["push"] < parts["window"]).all()
    assert (parts["window"] <= 20 * parts["push"]).all()


def test_stack_is_measured(tmp_path: Path) -> None:
    needs(CORTEX_M4)
    little, much = (
        counted(build(method(tmp_path / str(size), stack=size), CORTEX_M4, tmp_path / f"out{size}"), CORTEX_M4)[1]
        for size in (40, 5040)
    )
    assert 40 < little < 200
    assert much - little == 5000


def test_more_stack_than_there_is_is_an_error(tmp_path: Path) -> None:
    needs(CORTEX_M4)
    program = build(method(tmp_path / "c", stack=2**20), CORTEX_M4, tmp_path / "out")
    with pytest.raises(RuntimeError, match="more stack than the megabyte"):
        decide(program, CORTEX_M4, *recordings(1), counted=True)


def test_sizes_are_what_is_linked(tmp_path: Path) -> None:
    needs(CORTEX_M4)
    table = "static const unsigned char table[3000] = {1};\nstatic float kept[100];\n"
    use = CLASSIFIER.replace("ROUNDS", "(int)(table[(int)row[0]] + (kept[2] += row[0]))")
    plain = sizes(method(tmp_path / "plain"), CORTEX_M4)
    larger = sizes(method(tmp_path / "larger", classifier=table + use), CORTEX_M4)
    assert {"front", "tree", "libm"} <= set(plain.flash)
    assert not {"main", "size"} & set(plain.flash)
    assert 3000 <= larger.flash["tree"] - plain.flash["tree"] < 3100
    assert larger.flash["front"] == plain.flash["front"]
    assert larger.ram - plain.ram == 400


def test_the_sanitizers_see_an_overflow(tmp_path: Path) -> None:
    needs(HOST_SANITIZED)
    beyond = CLASSIFIER.replace("i < STACK", "i < STACK + (row[0] > 0)")
    program = build(method(tmp_path / "c", classifier=beyond), HOST_SANITIZED, tmp_path / "out")
    with pytest.raises(RuntimeError, match=r"out of bounds|stack-buffer-overflow"):
        decide(program, HOST_SANITIZED, *recordings())


def test_a_warning_is_an_error(tmp_path: Path) -> None:
    needs(HOST)
    doubled = CLASSIFIER.replace("1 / (1", "1.0 / (1")
    with pytest.raises(RuntimeError, match="double"):
        build(method(tmp_path / "c", classifier=doubled), HOST, tmp_path / "out")


def test_counting_needs_an_emulator(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="take an emulated machine"):
        decide(tmp_path / "program", HOST, *recordings(), counted=True)


def test_absent_tools_are_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ValueError, match=r"gcc-arm-none-eabi, qemu-system-arm: run scripts/install_arm\.sh"):
        require_tools(CORTEX_M4)
    with pytest.raises(ValueError, match="package gcc: run 'apt-get install gcc'"):
        build(tmp_path, HOST, tmp_path / "out")
