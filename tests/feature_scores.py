"""Features found on the solids of `parts`, and how many of them are right."""

import numpy as np

import rinow


def features_of(part):
    return rinow.singular_features((part.vertices, part.faces))


def precision_and_recall(found, true):
    """Precision and recall of two sets of rows."""
    a, b = {tuple(np.atleast_1d(x)) for x in found}, {tuple(np.atleast_1d(x)) for x in true}
    common = len(a & b)
    return common / max(len(a), 1), common / max(len(b), 1)
