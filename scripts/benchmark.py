"""The command ``swg benchmark``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("benchmark")
