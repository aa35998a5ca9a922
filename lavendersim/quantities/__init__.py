"""Numbers of a config: SI quantities with unit and bounds as field types, and words for them."""
