"""Error and efficiency of a picture, and the agreement of two renderers."""

import numpy as np

# Share of the pixels, the worst ones, that is left out.
TRIMMED = 0.001
# Dark pixels count by this share of the mean at least.
FLOOR = 0.01


def relative_mse(image, reference, reference_variance=0.0):
    """Mean of ((image - reference) / reference)^2 over all pixels but the worst."""
    scale = reference**2 + (FLOOR * reference.mean()) ** 2
    errors = np.sort(((image - reference) ** 2 / scale).ravel())
    return errors[: int(np.ceil(len(errors) * (1 - TRIMMED)))].mean()


def regions(image, side=64):
    """Means over squares."""
    height, width = image.shape
    return image.reshape(height // side, side, width // side, side).mean(axis=(1, 3))
