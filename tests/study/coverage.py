"""What the 95 % intervals of Monte Carlo cover, over 20,000 seeds: the unit test, long."""
import os
import subprocess
import sys

BUILD = os.environ.get("builddir", "build")

sys.exit(subprocess.run([os.path.join(BUILD, "tests/unit/test_interval"), "20000"]).returncode)
