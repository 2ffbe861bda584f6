"""The closed forms of exact_solutions.py on finer grids. Prints TAP."""
import exact_solutions
import scenes

exact_solutions.main(True)
scenes.done()
