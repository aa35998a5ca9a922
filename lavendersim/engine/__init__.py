"""The engine: kernels of contact dynamics over arrays, composed from what a scene requires."""
