"""As reaction_schemes.py, with every scheme on every scene. Prints TAP."""
import reaction_cases
import scenes

for case in reaction_cases.CASES:
    figures = reaction_cases.Figures()
    for scheme in reaction_cases.schemes():
        figures.measure(case, scheme)
    figures.told(case[0])
scenes.done()
