"""What a config may say of measures and expectations: its sections `measure`, `expect`, `always`.

Models alone, light to import: a config is read without numpy. The functions that take a measure
from a log stand in `lavendersim/measures/kinds`, in a file of the same name as its model's.
"""
