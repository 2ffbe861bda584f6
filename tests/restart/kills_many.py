"""The same as kills.py with two hundred kills. Prints TAP."""
import kills

kills.main(200)
