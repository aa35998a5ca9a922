"""Arrays in, arrays out: the kernels of contact dynamics, composed from what a scene requires."""
