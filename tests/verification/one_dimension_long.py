"""The ladders of one_dimension.py in full: 100 000 steps, noise in every combination, fine grids.
Prints TAP."""
import one_dimension

one_dimension.run(one_dimension.LONG)
