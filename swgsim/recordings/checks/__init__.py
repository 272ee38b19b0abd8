"""What the numbers of recordings show of a test bench: defects are reported, never silently mended."""
