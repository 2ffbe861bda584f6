# Spelling and shell scripts, where the tools for it are installed.
# shellcheck disable=SC2154 # srcdir comes from the harness
cd "$srcdir" || exit 1
number=0

# judge NAME TOOL COMMAND...
judge()
{
  local name=$1 tool=$2 output
  shift 2
  number=$((number + 1))
  if ! command -v "$tool" >/dev/null; then
    echo "ok $number - $name # SKIP $tool is not installed"
  elif output=$("$@" 2>&1); then
    echo "ok $number - $name"
  else
    echo "not ok $number - $name"
    printf '%s\n' "$output" | head -n 200 | sed 's/^/# /'
  fi
}

mapfile -t scripts < <(find tests -name '*.sh' | sort)
# Not the tests: they misspell on purpose.
mapfile -t words < <(find framework plugins inputs docs -type f \
  \( -name '*.[ch]' -o -name '*.md' -o -name '*.yaml' \) | sort)

judge 'shell scripts' shellcheck shellcheck -s bash -S warning bootstrap .ci/run "${scripts[@]}"
judge 'spelling' codespell codespell -q 3 --ignore-words tests/lint/words.txt \
  ./*.md "${words[@]}"
echo "1..$number"
