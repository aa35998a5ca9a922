"""Peers: other engines, which run lavender's scenes, each in a process of its own.

    declaration   what an engine says of itself: variants, settings, shapes, keys, what it reports
    catalogue     the engines, by the names that a config has; which are installed
    limits        what of a cell an engine cannot do, each with its key
    description   a cell as adapters read it: bodies, gravity, mixed surfaces, forces of a step
    mujoco, ...   one file an engine: its declaration and its adapter, a `World`
    child         the process of a run: builds, checks what was built, steps, sends rows
    process       the same from outside: starts it, takes its rows, sees it crash or hang

Declarations import no engine; adapters do, in the child alone.
"""
