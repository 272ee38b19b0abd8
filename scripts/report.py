"""The command ``swg report``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("report")
