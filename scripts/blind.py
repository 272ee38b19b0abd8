"""The command ``swg blind``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("blind")
