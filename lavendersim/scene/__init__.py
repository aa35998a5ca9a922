"""What a cell becomes: the plan of its effects, the engine's records, the queue of changes."""
