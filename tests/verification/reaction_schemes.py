"""What walls and moving boundaries report, for every transfer, shape and order: the momentum given
to the material is the impulse on the planes, and a unilateral wall never pulls. Each scheme has one
of the scenes; reaction_schemes_fine.py has them all. Prints TAP."""
import reaction_cases
import scenes

figures = {}
for number, scheme in enumerate(reaction_cases.schemes()):
    case = reaction_cases.CASES[number % len(reaction_cases.CASES)]
    figures.setdefault(scheme[0], reaction_cases.Figures()).measure(case, scheme)
for shape, found in figures.items():
    found.told(shape)
scenes.done()
