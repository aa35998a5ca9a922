"""From a config as written to the resolved cell: presets, placement, principal frames."""
