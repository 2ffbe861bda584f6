#!/usr/bin/env bash
# Seconds of processor time that `gamut check` takes for eight large scene files; 2 s each are
# asked for. By hand on a quiet machine: tests/bench/reading.sh, with gamut in $GAMUT or in build/.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd -P)
exec "${PYTHON:-python3}" "$here/../bad_inputs/big.py" --seconds
