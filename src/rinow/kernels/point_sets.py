"""Squared chords of points of S_k: the numbers that make the Gram matrix of a point set."""

from rinow.kernels._jit import kernel
from rinow.kernels.spaceform import log_sine_derivative, sine


@kernel
def squared_chords(D, k, chords, slopes):
    """Write 4 s_k(d/2)² and its derivative in k for each distance d."""
    for i in range(D.shape[0]):
        for j in range(D.shape[1]):
            half = sine(0.5 * D[i, j], k)
            chords[i, j] = 4.0 * half * half
            slopes[i, j] = 2.0 * chords[i, j] * log_sine_derivative(0.5 * D[i, j], k)
