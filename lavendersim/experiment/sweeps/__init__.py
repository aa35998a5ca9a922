"""What varies a config: the axes of a sweep, the reduced length, another solver, a cost grid."""
