"""The help of a command says what its choices are."""

import pytest
import yaml

from swgsim.commands.command import command, commands, config_name
from swgsim.commands.usage import usage
from swgsim.common.configured import conf_folder

FILES = {name: config_name(name) for name in commands()}


@pytest.mark.parametrize(("name", "file"), FILES.items())
def test_every_choice_of_a_command_is_in_its_help(name: str, file: str) -> None:
    config = yaml.safe_load((conf_folder() / f"{file}.yaml").read_text(encoding="utf-8"))
    lines = usage(name, file).splitlines()
    groups = [key for each in config.pop("defaults") if isinstance(each, dict) for key in each]
    values = {key: value for key, value in config.items() if key != "hydra" and not isinstance(value, dict)}
    for wanted in [*(key for key in groups if not key.startswith("override")), *values]:
        assert any(line.startswith((f"  {wanted}=", f"  {wanted}:")) for line in lines), wanted


def test_help_has_the_comments_of_the_file_and_no_value_of_a_group() -> None:
    text = usage("close-loop", "close_loop")
    assert text.startswith("Find the physical effect that a model of a gear")
    assert "  joint=null                  which joint of the robot" in text
    assert "one of gear1, gear2, gear3" in text
    assert "alpha_tooth" not in text
    assert "hydra" not in text


def test_nested_values_have_the_keys_that_lead_to_them() -> None:
    assert "  sessions.repeats=3" in usage("record", "record").splitlines()


def test_help_is_printed_instead_of_a_run(capsys: pytest.CaptureFixture[str]) -> None:
    command("effects", ["only=*friction*", "--help"])
    assert capsys.readouterr().out == usage("effects", "effects") + "\n"
