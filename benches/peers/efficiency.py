"""Error of a picture, and the agreement of two renderers."""

import numpy as np

# Share of the pixels, the worst ones, that is left out.
TRIMMED = 0.001
# Dark pixels count by this share of the mean at least.
FLOOR = 0.01
# Columns and rows of the grid whose means are compared.
GRID = (8, 6)
# Side of the squares whose means tell errors that neighbours have in common, px.
BOX_PX = 16


def relative_mse(pictures, trimmed=TRIMMED):
    """Of independent pictures with equal samples, against their mean, which stands for the converged picture.

    (picture - mean)^2 / (mean^2 + (1 % of the picture's mean)^2), averaged over all pixels but the worst, and times
    n / (n - 1), because the mean of n pictures contains each of them.
    """
    mean = np.mean(pictures, axis=0)
    scale = mean**2 + (FLOOR * mean.mean()) ** 2
    kept = int(np.ceil(mean.size * (1 - trimmed)))
    errors = [np.sort(((p - mean) ** 2 / scale).ravel())[:kept].mean() for p in pictures]
    return float(np.mean(errors) * len(pictures) / (len(pictures) - 1))


def box_mse(pictures):
    """The relative mean squared error of means over squares of `BOX_PX`, of all of them.

    Independent errors shrink by the number of pixels in a square; what a whole square has in common stays.
    """
    height, width = pictures[0].shape
    return relative_mse([grid_means(p, width // BOX_PX, height // BOX_PX) for p in pictures], trimmed=0.0)


def road_rms(pictures, road):
    """Standard error of a pixel of the road over the road's mean: no pixel is left out."""
    (left, right), (top, bottom) = road["columns"], road["rows"]
    cut = np.array([p[top:bottom, left:right] for p in pictures])
    return float(np.sqrt(cut.var(axis=0, ddof=1).mean()) / cut.mean())


def grid_means(image, columns, rows):
    """Means over the cells of a grid."""
    height, width = image.shape
    return image.reshape(rows, height // rows, columns, width // columns).mean(axis=(1, 3))


def ratios(images, others):
    """Of two renderers' independent pictures: the ratio of their means in each region, and its standard error."""
    def mean_and_error(pictures):
        means = np.array([grid_means(p, *GRID) for p in pictures])
        return means.mean(axis=0), means.std(axis=0, ddof=1) / np.sqrt(len(means))
    (a, da), (b, db) = mean_and_error(images), mean_and_error(others)
    lit = (a > 0) & (b > 0)
    ratio = a[lit] / b[lit]
    return ratio, ratio * np.hypot(da[lit] / a[lit], db[lit] / b[lit])
