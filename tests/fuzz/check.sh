# Every reader takes its corpus, then what libFuzzer makes of it in a few seconds, always the same.
# Where the compiler has no libFuzzer the corpus is read, with the sanitizers that the tree is built
# with.
# shellcheck disable=SC2154 # srcdir and builddir come from the harness
number=0
failures=0
for reader in scene descriptor points checkpoint results; do
  number=$((number + 1))
  output=$(FUZZ_SEED=1 "${BASH:-bash}" "$srcdir/tests/fuzz/run.sh" "${FUZZ_SECONDS:-4}" $reader)
  code=$?
  inputs=$(sed -n 's/^stat::number_of_executed_units: *//p; s/^replay: \([0-9]*\) files$/\1/p' \
    <<<"$output")
  if [ $code -eq 0 ]; then
    echo "ok $number - $reader: ${inputs:-0} inputs without a fault"
  else
    echo "not ok $number - $reader: a fault"
    failures=1
    tail -n 60 <<<"$output" | sed 's/^/# /'
  fi
done
echo "1..$number"
exit $failures
