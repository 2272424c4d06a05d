"""Refutations checked by going through all clauses again and again."""


def contradicts(clauses, true):
    """Whether unit propagation from the true literals makes a clause false."""
    true = set(true)
    while True:
        if any(-literal in true for literal in true):
            return True
        new = set()
        for clause in clauses:
            if not any(literal in true for literal in clause):
                left = {literal for literal in clause if -literal not in true}
                if not left:
                    return True
                if len(left) == 1:
                    new |= left
        if not new:
            return False
        true |= new


def is_refuted(clauses, proof):
    """Whether all learned clauses up to a contradiction follow; clauses to forget are kept."""
    known = list(clauses)
    for line in proof:
        if contradicts(known, []):
            return True
        if not line.startswith("d"):
            learned = [int(word) for word in line.split()[:-1]]
            if not contradicts(known, [-literal for literal in learned]):
                return False
            known.append(learned)
    return contradicts(known, [])
