#!/bin/bash
# Four sessions in four threads under the thread sanitizer: a build of its own. Prints TAP.
set -u
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo 1..1
echo 'int main(void) { return 0; }' > "$work/x.c"
if ! $CC -fsanitize=thread "$work/x.c" -o "$work/x" 2> /dev/null || ! "$work/x"; then
  echo "ok 1 - sessions in threads # SKIP the compiler has no thread sanitizer"
  exit 0
fi
# shellcheck disable=SC2154 # from the harness
source=$(cd "$srcdir" && pwd)
mkdir "$work/build" && cd "$work/build" || exit 1
{ "$source/configure" --disable-levels --enable-thread-sanitizer CC="$CC" &&
  make -j2 all tests/unit/test_embed; } > "$work/log" 2>&1
# OpenMP's runtime is not built for the sanitizer, which would call its barriers races.
builddir=$work/build OMP_NUM_THREADS=1 TSAN_OPTIONS="halt_on_error=0 exitcode=66" \
  tests/unit/test_embed > "$work/out" 2>&1
code=$?
races=$(grep -c 'WARNING: ThreadSanitizer' "$work/out")
if [ "$code" = 0 ] && [ "$races" = 0 ]; then
  echo "ok 1 - sessions in threads: $races races (allowed 0)"
else
  echo "not ok 1 - sessions in threads: exit $code, $races races (allowed 0)"
  { tail -5 "$work/log"; head -60 "$work/out"; } | sed 's/^/# /'
fi
