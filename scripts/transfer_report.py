"""The command ``swg transfer-report``."""

from swgsim.commands import command

if __name__ == "__main__":
    command("transfer-report")
