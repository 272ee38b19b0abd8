"""The command ``swg embedded``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("embedded")
