"""The benchmark compares like with like; its ratios are not tested, its differences are."""

from chain_fixtures import small_plan

from swgsim.studies import benchmark


def test_chain_and_direct_solver_agree(monkeypatch: object) -> None:
    monkeypatch.setattr(benchmark, "INSTANTS", 4)
    result = benchmark.chain_vs_solve_per_step(small_plan())
    assert result["max_relative_difference"] < 1e-5
    assert result["recordings"] == small_plan().grid.count()


def test_errors_by_recording_are_the_dense_ones():
    assert benchmark.errors_by_recording_vs_dense(3, 20, 4, 6)["max_relative_difference"] < 1e-10


def test_further_errors_are_as_those_that_were_there_from_the_start():
    assert benchmark.further_errors_vs_anew(3, 20, 4, 6, 3)["max_relative_difference"] < 1e-10
