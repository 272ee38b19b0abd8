"""The command ``swg upload``."""

from collections.abc import Mapping
from typing import Any


def run(config: Mapping[str, Any]) -> None:
    """Upload the runs of this machine that the team's server lacks."""
    from learn.jobs.settings import store
    from learn.tracking import StoreAway, upload
    from learn.tracking.store import lost

    uri = config["tracking"]["uri"]
    try:
        new = upload(store(config["tracking"]))
    except StoreAway:  # has a remedy of its own
        raise
    except lost() as error:
        raise SystemExit(
            f"the server at {uri} went away: when it is back, give the same command again ({error})"
        ) from error
    print(f"{new} runs were new to {uri}")
