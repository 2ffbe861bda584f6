"""Every shape with every transfer and order, and finer grids; takes many minutes. Prints TAP."""
import bar_schemes
import free_bodies
import manufactured
import patches
import rigid_motion
import scenes

for suite in (patches, rigid_motion, free_bodies, bar_schemes, manufactured):
    suite.main(True)
scenes.done()
