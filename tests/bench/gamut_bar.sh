#!/bin/bash
# Times of the deformation-gamut bar beside what was asked. Not part of make check: it wants a quiet
# machine. GAMUT=build/gamut bash tests/bench/gamut_bar.sh
set -eu
here=$(cd "$(dirname "$0")/../.." && pwd)
gamut=${GAMUT:-$here/build/gamut}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# figure KEY FILE: a number of the summary's cost
figure() { sed -n "s/^ *\"$1\": *\([0-9.eE+-]*\),*$/\1/p" "$2" | tail -1; }

run() {
  "$gamut" run "$@" -o "$scratch/run" --force --json >"$scratch/summary.json" 2>"$scratch/messages"
}

for bar in al7075 ti64; do
  run "$here/inputs/bar_$bar.yaml" --threads 1
  echo "bar_$bar, one run of 500 bonds: $(figure wall_s "$scratch/summary.json") s (asked 0.15)"
done
begin=$(date +%s.%N)
for bar in al7075 ti64; do
  for grid in uniform random; do
    run "$here/inputs/bar_${bar}_random.yaml" --threads 2 --set solver.grid=$grid
  done
done
end=$(date +%s.%N)
echo "120 realisations on two threads: $(echo "$end - $begin" | bc) s (asked 40)"

cat >"$scratch/big.yaml" <<SCENE
gamut: 1
include: [$here/inputs/materials/7075.yaml]
solver:
  model: gamut_bar
  bonds: 200000
  grid: random
  start: 0.9
  strain_limit: 0.02
  noise:
    modulus: {model: white, distribution: weibull}
    softness: {model: white, distribution: weibull}
bodies:
  bar: {material: al7075, length: 100 mm, area: 100 mm2}
quantities:
  stress_strain: {measure: stress_strain}
SCENE
run "$scratch/big.yaml" --threads 2
steps=$(figure steps "$scratch/summary.json")
wall=$(figure wall_s "$scratch/summary.json")
echo "200000 bonds: $(echo "scale=3; $wall / $steps" | bc) s a load step (asked 1)," \
  "$(figure bytes_per_point "$scratch/summary.json") bytes a bond"
