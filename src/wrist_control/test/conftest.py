"""How Hypothesis looks for examples.

Here, so that these tests need nothing from outside the package; the root's conftest.py reads it
for all others.
"""

import os

from hypothesis import settings

# How long an example takes says more about the machine than about the code.
settings.register_profile('default', deadline=None)
# New examples in every run, and what is needed to see a failing one again on another machine.
settings.register_profile('ci', deadline=None, database=None, derandomize=False, print_blob=True)
settings.load_profile('ci' if 'CI' in os.environ else 'default')
