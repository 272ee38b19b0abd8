"""The command ``swg server``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("server")
