"""How far the stars of points agree, from sets of triangles."""


def triangles(point, star):
    """The triangles of a point and two successive neighbours, each as its set of corners."""
    return [frozenset((point, star[i - 1], star[i])) for i in range(len(star))]


def agreement(stars):
    """For each star the share of its triangles that the stars of their other corners have, too; 0 for none."""
    held = [set(triangles(point, star)) for point, star in enumerate(stars)]
    shares = []
    for point, star in enumerate(stars):
        own = triangles(point, star)
        agreed = [t for t in own if len(t) == 3 and all(t in held[corner] for corner in t)]
        shares.append(len(agreed) / len(own) if own else 0.0)
    return shares
