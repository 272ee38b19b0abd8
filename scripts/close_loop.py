"""The command ``swg close-loop``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("close-loop")
