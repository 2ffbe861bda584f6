"""The same as damage.py at 72 places of each file. Prints TAP."""
import damage

damage.main(72)
