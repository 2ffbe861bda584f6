# Every public header compiles alone, as C11 and as C++, with no warning.
# shellcheck disable=SC2154 # srcdir and the compilers come from the harness
cd "$srcdir/framework/include" || exit 1
number=0

# compiles NAME COMMAND...
compiles()
{
  local name=$1 output
  shift
  number=$((number + 1))
  if output=$("$@" 2>&1); then
    echo "ok $number - $name"
  else
    echo "not ok $number - $name"
    printf '%s\n' "$output" | head -n 40 | sed 's/^/# /'
  fi
}

warnings=(-Wall -Wextra -Wpedantic -Wshadow -Werror -fsyntax-only -I.)
for header in gamut/*.h; do
  # shellcheck disable=SC2086 # CC may hold flags
  compiles "$header as C11" $CC -std=c11 -Wconversion "${warnings[@]}" -x c "$header"
  if [ -z "$CXX" ]; then
    number=$((number + 1))
    echo "ok $number - $header as C++ # SKIP no C++ compiler"
  else
    # shellcheck disable=SC2086
    compiles "$header as C++" $CXX -std=c++17 "${warnings[@]}" -x c++ "$header"
  fi
done
echo "1..$number"
