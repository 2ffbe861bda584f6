# run.sh SECONDS READER...: each reader from its corpus for so many seconds. What is new and
# interesting goes to $builddir/fuzz/found/READER, an input that fails to $builddir/fuzz/faults.
# FUZZ_RUNS (a number) bounds the inputs, FUZZ_SEED fixes their order, FUZZ_PROGRAMS is the folder
# of the readers, FUZZ_TIMEOUT the seconds by the clock that an input may take (more where others
# use the machine).
# shellcheck disable=SC2154 # srcdir and builddir come from the harness
set -u
seconds=$1
shift
here=$srcdir/tests/fuzz
memory=/dev/shm # inputs are files, thousands a second
[ -w "$memory" ] || memory=${TMPDIR:-/tmp}
scratch=$(mktemp -d -p "$memory") || exit 1
trap 'rm -rf "$scratch"' EXIT
export TMPDIR=$scratch GAMUT_FUZZ_PLUGINS=$builddir
export ASAN_OPTIONS=detect_leaks=1:allocator_may_return_null=1
ASAN_OPTIONS+=:quarantine_size_mb=16:malloc_context_size=8
export UBSAN_OPTIONS=print_stacktrace=1
export ASAN_SYMBOLIZER_PATH="${ASAN_SYMBOLIZER_PATH:-$(command -v llvm-symbolizer)}"

# Where else a reader's inputs stand in the tree.
seeds()
{
  case $1 in
    scene) find "$srcdir/inputs" "$srcdir/tests/bad_inputs" "$srcdir/tests/scenes" -name '*.yaml' ;;
    descriptor) find "$srcdir/plugins" -name '*.yaml' ! -name '*.test.yaml' ;;
    points) find "$srcdir/tests/bad_inputs" -name '*.csv' ;;
  esac
}

dictionary()
{
  case $1 in
    scene | descriptor) echo "$here/yaml.dict" ;;
    points) echo "$here/csv.dict" ;;
    *) echo "$here/hdf5.dict" ;;
  esac
}

gather()
{
  local number=0 file
  mkdir -p "$scratch/$1"
  cp "$here/corpus/$1"/* "$scratch/$1"
  while read -r file; do
    number=$((number + 1))
    cp "$file" "$scratch/$1/tree-$number"
  done < <(seeds "$1" | sort)
}

worst=0
for reader in "$@"; do
  program=${FUZZ_PROGRAMS:-$builddir/fuzz}/$reader
  found=$builddir/fuzz/found/$reader
  gather "$reader"
  mkdir -p "$found" "$builddir/fuzz/faults"
  if "$program" -help=1 2>&1 | grep -q libFuzzer; then
    "$program" -max_len=8192 -timeout="${FUZZ_TIMEOUT:-10}" -rss_limit_mb=2048 \
      -max_total_time="$seconds" -runs="${FUZZ_RUNS:--1}" -seed="${FUZZ_SEED:-0}" \
      -print_final_stats=1 \
      -artifact_prefix="$builddir/fuzz/faults/$reader-" -dict="$(dictionary "$reader")" \
      "$found" "$scratch/$reader" 2>&1
  else
    "$program" "$scratch/$reader"/* 2>&1
  fi
  code=$?
  [ $code -eq 0 ] || worst=1
  echo "$reader: exit $code"
done
exit $worst
