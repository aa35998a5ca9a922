"""How far off is what the default numerics give, scene by scene, at three timesteps?"""
