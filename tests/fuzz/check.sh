# Every reader takes its corpus and the tree's own files of its kind, built with the compiler and
# the sanitizers of the tree. libFuzzer goes on from there in check-long (long.sh) and `make fuzz`.
# shellcheck disable=SC2154 # srcdir and builddir come from the harness
FUZZ_PROGRAMS=$builddir/fuzz/replay "${BASH:-bash}" "$srcdir/tests/fuzz/readers.sh" 0
