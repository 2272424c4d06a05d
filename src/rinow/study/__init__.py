"""Topics composed into one frozen result, as users want to read it.

`surface` with `totals`, `features`, `points`, `spaces`; `comparison` of two shapes, and `convergence` to a limit.
"""
