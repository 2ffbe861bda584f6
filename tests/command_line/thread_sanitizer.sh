#!/bin/bash
# Four sessions in four threads under the thread sanitizer: a build of its own. Prints TAP.
set -u
: "${srcdir:?}" "${CC:?}"
unset MAKEFLAGS MAKELEVEL MFLAGS
source=$(cd "$srcdir" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1

# A race that is meant, so that silence means something.
cat >race.c <<'END'
#include <pthread.h>
static int shared;
static void *add(void *unused) { shared++; return unused; }
int main(void)
{
  pthread_t one, other;
  pthread_create(&one, 0, add, 0);
  pthread_create(&other, 0, add, 0);
  pthread_join(one, 0);
  pthread_join(other, 0);
  return 0;
}
END
echo 'int main(void) { return 0; }' >sound.c
# shellcheck disable=SC2086 # the compiler may come with a launcher
if ! $CC -fsanitize=thread sound.c -o sound 2>log || ! ./sound; then
  echo '1..0 # SKIP the compiler has no thread sanitizer that runs here'
  exit 77
fi
echo 1..2
export TSAN_OPTIONS='halt_on_error=0 exitcode=66' OMP_NUM_THREADS=1
# shellcheck disable=SC2086
$CC -fsanitize=thread -pthread race.c -o race 2>log
./race >out 2>&1
code=$?
if [ "$code" = 66 ]; then
  echo 'ok 1 - a planted race is found: exit 66 (due 66)'
else
  echo "not ok 1 - a planted race is found: exit $code (due 66)"
fi

{ "$source/configure" --disable-levels --enable-thread-sanitizer CC="$CC" &&
  make -j2 all tests/unit/test_embed; } >log 2>&1
builddir=$work tests/unit/test_embed >out 2>&1
code=$?
races=$(grep -c 'WARNING: ThreadSanitizer' out)
if [ "$code" = 0 ] && [ "$races" = 0 ]; then
  echo "ok 2 - sessions in threads: $races races (allowed 0)"
else
  echo "not ok 2 - sessions in threads: exit $code, $races races (allowed 0)"
  { tail -5 log; head -60 out; } | sed 's/^/# /'
fi
