"""What integrators share: problems, batches, consistent starts, matrices, outputs."""
