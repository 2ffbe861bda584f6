# Runs one test program under valgrind and judges only its use of memory: valgrind computes long
# double in 64 bits, so checks of the last digit fail there. Only what is definitely lost counts:
# the C library's search trees, which UDUNITS keeps, mark their pointers and look possibly lost.
output=$("${VALGRIND:-valgrind}" --quiet --error-exitcode=99 --leak-check=full \
  --show-leak-kinds=definite --errors-for-leak-kinds=definite "$@" 2>&1)
[ $? -ne 99 ] || printf 'not '
echo "ok 1 - memory of $1"
printf '%s\n' "$output" | grep '^==' | head -n 60 | sed 's/^/# /'
echo "1..1"
