"""The command ``swg ui``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("ui")
