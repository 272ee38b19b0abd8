"""The command ``swg map``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("map")
