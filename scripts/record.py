"""The command ``swg record``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("record")
