"""How Hypothesis looks for examples, and what tests of every folder measure by.

These tests need nothing from outside the package; the root's conftest.py reads the settings here
for all others.
"""

import os

import numpy as np
import pytest
from hypothesis import settings

# How long an example takes says more about the machine than about the code.
settings.register_profile('default', deadline=None)
# New examples in every run, and what is needed to see a failing one again on another machine.
settings.register_profile('ci', deadline=None, database=None, derandomize=False, print_blob=True)
settings.load_profile('ci' if 'CI' in os.environ else 'default')


@pytest.fixture(scope='session')
def slopes():
    """Differentiate a function of some numbers: a column for each, by central differences."""

    def differences(function, x, h=1e-6):
        x = np.asarray(x, float)
        ends = [(function(x + h * e), function(x - h * e)) for e in np.eye(len(x))]
        return np.array([np.subtract(high, low) / (2.0 * h) for high, low in ends]).T

    return differences
