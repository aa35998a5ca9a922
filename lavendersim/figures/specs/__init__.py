"""What a config may say of its figure: the section `figure`, a model per kind of panel.

Models alone, light to import: a config is read without numpy and matplotlib. The functions that
draw stand in `lavendersim/figures/panels`, in a file of the same name as its model's.
"""
