"""``python -m swgsim``: the commands."""

import sys

from swgsim.commands.main import main

sys.exit(main())
