"""The same as out_of_memory.py at a thousand places of each command. Prints TAP."""
import out_of_memory

out_of_memory.main(1000)
