"""Settings of the whole test run."""

import os

from hypothesis import settings

# No deadline: the first example of a kernel compiles it.  The same examples each time in CI, fresh ones at a desk.
settings.register_profile("rinow", deadline=None, derandomize=bool(os.environ.get("CI")))
settings.load_profile("rinow")
