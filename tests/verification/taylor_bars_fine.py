"""As taylor_bars.py on finer grids; takes minutes."""
import taylor_bars

taylor_bars.main(True)
