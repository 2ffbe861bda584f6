# Every GAMUT_EACH loop of the plugins vectorises at the instruction-set levels that are built: one
# that falls back to single numbers is several times slower and says nothing.
# shellcheck disable=SC2154 # srcdir, builddir and the compiler come from the harness
cd "$srcdir" || exit 1
if ! plugin_flags=$(PKG_CONFIG_PATH=$builddir pkg-config --variable=plugin_cflags gamut); then
  echo '1..0 # SKIP no pkg-config, which knows the flags of plugins'
  exit 77
fi
number=0

# A GAMUT_EACH stands where the compiler reports its loop, or a line above. One inside a macro is
# reported where the macro is used. Prints the lines of loops that are not reported.
read -r -d '' missing <<'AWK'
FILENAME == ARGV[1] { if (match($0, /:[0-9]+:[0-9]+: optimized: +loop vectorized/)) {
              split(substr($0, RSTART + 1), place, ":"); seen[place[1]] = 1 }
            next }
/^#define/ { define = $2; sub(/\(.*/, "", define) }
/GAMUT_EACH/ { if (define != "") macro[define] = 1;
               else if (!seen[FNR] && !seen[FNR + 1]) print FNR }
!/^#define/ && define == "" { for (name in macro)
                                if ($0 ~ "(^|[^A-Za-z_])" name "\\(" && !seen[FNR]) print FNR }
!/\\$/ { define = "" }
AWK

# vectorises LEVEL FILE FLAGS...
vectorises()
{
  local level=$1 file=$2 report lines
  shift 2
  number=$((number + 1))
  # With -g the places are those of the loops. Distribution off: it splits
  # loops, of which one half may vectorise, or makes a memset of them, fast but not reported.
  # shellcheck disable=SC2086 # CC may hold flags
  if ! report=$($CC -g $plugin_flags "$@" \
    -fno-tree-loop-distribute-patterns -fno-tree-loop-distribution -Iframework/include \
    "-I$builddir/$(dirname "$file")" "-I$(dirname "$file")" -fopt-info-vec-optimized \
    -S -o /dev/null "$file" 2>&1); then
    echo "not ok $number - $file compiles for $level"
    printf '%s\n' "$report" | head -n 20 | sed 's/^/# /'
    return
  fi
  lines=$(awk "$missing" <(printf '%s\n' "$report" | grep -F "$file:") "$file" | tr '\n' ' ')
  if [ -z "$lines" ]; then
    echo "ok $number - $file vectorises for $level"
  else
    echo "not ok $number - $file vectorises for $level # not the loops at lines $lines"
  fi
}

# shellcheck disable=SC2086
case $($CC --version 2>/dev/null; $CC -dumpmachine 2>/dev/null) in
  *clang*) echo '1..0 # SKIP the report is that of gcc'; exit 0 ;;
  *x86_64*) ;;
  *) echo '1..0 # SKIP the levels are those of x86-64'; exit 0 ;;
esac
mapfile -t files < <(grep -l GAMUT_EACH plugins/{eos,strength,elasticity,effect}/*/*.c | sort)
for file in "${files[@]}"; do
  vectorises v3 "$file" -march=x86-64-v3
  vectorises v4 "$file" -march=x86-64-v4 -mprefer-vector-width=512
done
echo "1..$number"
