"""How each engine builds and steps a scene; importing one imports its engine."""
