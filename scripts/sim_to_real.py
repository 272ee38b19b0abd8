"""The command ``swg sim-to-real``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("sim-to-real")
