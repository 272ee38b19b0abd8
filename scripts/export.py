"""The command ``swg export``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("export")
