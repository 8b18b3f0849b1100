"""Blocks of records, which validation leaves out one by one."""

import numpy as np

from dalembert.inverse.experiments.blocks import blocks_of_records


def test_values_that_were_not_fitted_belong_to_no_block():
    fitted = np.array([[True], [False], [True], [True]])
    assert blocks_of_records(fitted, (), lambda samples: 2).ravel().tolist() == [0, -1, 0, 1]
