# readers.sh SECONDS: all readers by run.sh, as a test.
# shellcheck disable=SC2154 # srcdir and builddir come from the harness
number=0
failures=0
for reader in scene descriptor points checkpoint results; do
  number=$((number + 1))
  output=$(FUZZ_SEED=1 "${BASH:-bash}" "$srcdir/tests/fuzz/run.sh" "$1" $reader)
  code=$?
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p; s/^replay: \([0-9]*\) files$/\1/p' \
    <<<"$output")
  if [ $code -eq 0 ] && [ "${inputs:-0}" -gt 0 ]; then
    echo "ok $number - $reader: ${inputs:-0} inputs without a fault"
  else
    echo "not ok $number - $reader: a fault, or nothing was read"
    failures=1
    tail -n 60 <<<"$output" | sed 's/^/# /'
  fi
done
echo "1..$number"
exit $failures
