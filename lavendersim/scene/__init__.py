"""What a config makes: mass properties, the engine's arrays, and the plan of its effects."""
