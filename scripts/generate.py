"""The command ``swg generate``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("generate")
