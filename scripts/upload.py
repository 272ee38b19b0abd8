"""Bring runs that were kept on this machine to a team's server."""

import hydra
from misspelt import answered
from omegaconf import DictConfig, OmegaConf


@hydra.main(version_base="1.3", config_path="../conf", config_name="upload")
def main(config: DictConfig) -> None:
    """Upload what the server lacks."""
    from learn.jobs.settings import store
    from learn.tracking import upload
    from learn.tracking.store import lost

    try:
        new = upload(store(OmegaConf.to_container(config.tracking)))  # type: ignore[arg-type]
    except ValueError as error:
        raise SystemExit(str(error)) from error
    except lost() as error:
        raise SystemExit(
            f"the server at {config.tracking.uri} went away: when it is back, give the same command again ({error})"
        ) from error
    print(f"{new} runs were new to {config.tracking.uri}")


if __name__ == "__main__":
    answered(main, "upload")
