"""What a mistake in a command is answered with."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from hydra import compose, initialize_config_dir

from learn.commands.close_loop import require_one_kind
from swgsim.commands import interrupts
from swgsim.commands.mistakes import FULL, answered
from swgsim.common.configured import plain

ROOT = Path(__file__).parents[2]


def given(*words: str, **environment: str) -> subprocess.CompletedProcess:
    """The end of close-loop."""
    around = {name: value for name, value in os.environ.items() if name != FULL} | environment
    command = [sys.executable, "-m", "swgsim", "close-loop", *words]
    return subprocess.run(command, cwd=ROOT, env=around, capture_output=True, text=True, check=False)


def chosen(*words: str) -> dict:
    """The choices of close-loop."""
    with initialize_config_dir(str(ROOT / "conf"), version_base="1.3"):
        return plain(compose("close_loop", list(words)))


def test_a_name_that_is_a_number_is_a_name() -> None:
    names = {"recordings": "12", "commissioning": "11", "truth": "1.5"}
    found = chosen("recordings=12", "commissioning=11", "truth=1.5", "seed=3")
    assert {**names, "seed": 3, "mapping": None}.items() <= found.items()


@pytest.mark.slow
def test_a_name_that_looks_like_a_number_is_as_it_was_written() -> None:
    assert "recordings=2024_10_05: found nothing" in given("recordings=2024_10_05").stderr


@pytest.mark.slow
@pytest.mark.parametrize("words", [(), ("--multirun", "seed=1,2")])
def test_a_mistake_ends_with_a_sentence_and_not_with_a_traceback(words: tuple[str, ...]) -> None:
    answer = given(*words)
    assert answer.returncode == 1
    said = answer.stderr.splitlines()
    assert said[-2].startswith("no recordings: give recordings=FOLDER")
    assert said[-1] == f"({FULL}=1 shows where)"
    assert "Traceback" not in answer.stderr


@pytest.mark.slow
def test_the_traceback_is_there_for_who_asks() -> None:
    answer = given(**{FULL: "1"})
    assert answer.returncode == 1
    assert "Traceback" in answer.stderr
    assert "ValueError: no recordings" in answer.stderr


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("recordings", "cannot read 'recordings': choices are name=value, such as recordings=FOLDER"),
        (
            "recordings=run (1)",
            "cannot read 'recordings=run (1)': a value with such characters needs quotes",
        ),
        ("seed.x=1", "Could not override 'seed.x'"),
    ],
)
def test_a_word_that_is_no_choice_is_answered(word: str, said: str) -> None:
    answer = given(word)
    assert answer.returncode == 1
    assert answer.stderr.startswith(said)
    assert "Traceback" not in answer.stderr


@pytest.mark.parametrize(
    ("word", "said"),
    [
        ("gear=gaer1", "unknown gear 'gaer1'; did you mean 'gear1'? choose from gear1, gear2, gear3"),
        ("recording=a", "unknown choice 'recording'; did you mean 'recordings'? choose from commissioning, "),
    ],
)
def test_a_misspelt_choice_is_answered_with_the_nearest_alone(word: str, said: str) -> None:
    answer = given(word)
    assert answer.returncode == 1
    (line,) = answer.stderr.splitlines()
    assert line.startswith(said)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["holdout=S3"], "holdout= is for robot joints: give source= as well"),
        (["without=*Load"], "without= is for robot joints"),
        (["source=ur10e", "truth=a.json"], "truth= is for strain gauges, source=ur10e for robot joints"),
        (["source=ur10e", "effect=tilting_moment"], "effects= is for strain gauges"),
    ],
)
def test_a_choice_for_the_other_kind_of_recordings_is_refused(words: list[str], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        require_one_kind(chosen(*words))


@pytest.mark.parametrize(
    "words", [["effect=tilting_moment", "truth=a.json"], ["source=ur10e", "joint=joint_2", "holdout=S3", "gear=gear2"]]
)
def test_choices_for_one_kind_go_together(words: list[str]) -> None:
    require_one_kind(chosen(*words))


def test_a_list_of_patterns_is_read_as_the_pages_show_it() -> None:
    words = ["source=ur10e", "holdout=[*-20sec_10harm,*-50sec_12harm]", "without=*Load"]
    assert all(f'holdout="{words[1][8:]}"' in (ROOT / page).read_text() for page in ("README.md", "docs/joints.md"))
    assert chosen(*words)["holdout"] == ["*-20sec_10harm", "*-50sec_12harm"]


def test_an_error_that_is_no_mistake_keeps_its_traceback(monkeypatch: pytest.MonkeyPatch) -> None:
    def main() -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(interrupts, "kept", lambda: None)
    monkeypatch.delenv(FULL, raising=False)
    with pytest.raises(ZeroDivisionError):
        answered(main, "close_loop")
    assert FULL not in os.environ
