"""Error of a picture, and the agreement of two renderers."""

import numpy as np

# Share of the pixels, the worst ones, that is left out.
TRIMMED = 0.001
# Dark pixels count by this share of the mean at least.
FLOOR = 0.01
# Columns and rows of the grid whose means are compared.
GRID = (8, 6)


def relative_mse(pictures):
    """Of independent pictures with equal samples, against their mean, which stands for the converged picture.

    (picture - mean)^2 / (mean^2 + (1 % of the picture's mean)^2), averaged over all pixels but the worst, and times
    n / (n - 1), because the mean of n pictures contains each of them.
    """
    mean = np.mean(pictures, axis=0)
    scale = mean**2 + (FLOOR * mean.mean()) ** 2
    kept = int(np.ceil(mean.size * (1 - TRIMMED)))
    errors = [np.sort(((p - mean) ** 2 / scale).ravel())[:kept].mean() for p in pictures]
    return float(np.mean(errors) * len(pictures) / (len(pictures) - 1))


def regions(image):
    """Means over the squares of a grid."""
    columns, rows = GRID
    height, width = image.shape
    return image.reshape(rows, height // rows, columns, width // columns).mean(axis=(1, 3))


def ratios(images, others):
    """Of two renderers' independent pictures: the ratio of their means in each region, and its standard error."""
    def mean_and_error(pictures):
        means = np.array([regions(p) for p in pictures])
        return means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
    (a, da), (b, db) = mean_and_error(images), mean_and_error(others)
    lit = (a > 0) & (b > 0)
    ratio = a[lit] / b[lit]
    return ratio, ratio * np.hypot(da[lit] / a[lit], db[lit] / b[lit])
