"""Models of the section `figure` of a config: one per kind of panel.

Models alone, light to import: a config is read without numpy and matplotlib. The functions that
draw stand in `lavendersim/figures/panels`, in a file of the same name as its model's.
"""
