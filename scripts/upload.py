"""The command ``swg upload``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("upload")
