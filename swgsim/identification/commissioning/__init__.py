"""Commissioning: what healthy recordings show of a gear, and where they contradict the model."""
