"""Error of a picture, and the agreement of two renderers."""

import numpy as np

# Share of the pixels, the worst ones, that is left out.
TRIMMED = 0.001
# Dark pixels count by this share of the mean at least.
FLOOR = 0.01
# Columns and rows of the grid whose means are compared.
GRID = (8, 6)


def relative_mse(pictures):
    """Of independent pictures with equal samples, each against the mean of the others.

    (picture - reference)^2 / (reference^2 + (1 % of the mean)^2), the mean over all pixels but the worst. The error of
    the reference, that of a picture over their number, is taken off.
    """
    return float(np.mean([_against_others(pictures, i) for i in range(len(pictures))]))


def _against_others(pictures, i):
    others = [p for k, p in enumerate(pictures) if k != i]
    reference = np.mean(others, axis=0)
    scale = reference**2 + (FLOOR * reference.mean()) ** 2
    errors = np.sort(((pictures[i] - reference) ** 2 / scale).ravel())
    kept = errors[: int(np.ceil(len(errors) * (1 - TRIMMED)))]
    return kept.mean() / (1.0 + 1.0 / len(others))


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
