# What libFuzzer makes of each reader's corpus in some seconds, always from the same seed.
# shellcheck disable=SC2154 # srcdir and builddir come from the harness
if [ ! -x "$builddir/fuzz/scene" ]; then
  echo '1..0 # SKIP no clang with libFuzzer'
  exit 77
fi
"${BASH:-bash}" "$srcdir/tests/fuzz/readers.sh" "${FUZZ_SECONDS:-20}"
