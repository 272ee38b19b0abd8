"""The command ``swg oracle``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("oracle")
