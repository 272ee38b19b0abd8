"""The command ``swg joints``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("joints")
