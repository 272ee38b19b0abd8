"""The command ``swg twin``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("twin")
