"""The command ``swg train``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("train")
