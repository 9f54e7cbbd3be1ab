"""Pixels of pictures."""
import matplotlib.image
import numpy as np


def pixels(path):
    """The pixels (rows, columns, 3) of 0..255."""
    return np.round(matplotlib.image.imread(path)[:, :, :3] * 255).astype(int)
