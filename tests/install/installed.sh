# What `make installcheck` asks of an installed gamut: it finds its plugins, and a stranger's plugin
# of each kind, written by `gamut new`, builds with nothing but pkg-config and passes `verify`.
set -u
number=0
failures=0
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset GAMUT_PLUGIN_PATH MAKEFLAGS MAKELEVEL MFLAGS
: "${GAMUT:?}" "${includedir:?}" "${pkgdatadir:?}"
# A staged install (DESTDIR) does not lie where its .pc file says: point pkg-config at it.
export PKG_CONFIG_SYSROOT_DIR=${DESTDIR:-}
# shellcheck source=digests.sh
. "${0%/*}/digests.sh"

# try NAME COMMAND...
try()
{
  local name=$1 output
  shift
  number=$((number + 1))
  if output=$("$@" 2>&1 </dev/null); then
    echo "ok $number - $name"
  else
    echo "not ok $number - $name"
    failures=$((failures + 1))
    printf '%s\n' "$output" | tail -n 30 | sed 's/^/# /'
  fi
}

lists_every_plugin()
{
  local descriptor kind_and_name
  "$GAMUT" list >"$scratch/list" || return 1
  for descriptor in "$plugindir"/*/*/*.yaml; do
    kind_and_name=${descriptor#"$plugindir/"}
    case $descriptor in *.test.yaml) continue ;; esac
    kind_and_name=${kind_and_name%/*}
    # The list may group names by kind; the name alone must be there.
    grep -qw "${kind_and_name#*/}" "$scratch/list" || {
      echo "$kind_and_name is installed and not listed"
      return 1
    }
  done
}

header_compiles()
{
  echo '#include <gamut/plugin.h>' >"$scratch/header.c"
  # shellcheck disable=SC2046,SC2086 # lists of flags
  ${CC:-cc} -fsyntax-only $(pkg-config --cflags gamut) "$scratch/header.c"
}

# What a plugin author does.
new_plugin()
{
  local folder=$scratch/$1/trial
  mkdir "$scratch/$1" && "$GAMUT" new "$1/trial" -o "$folder" || return 1
  make -C "$folder" && "$GAMUT" verify "$folder"
}

no_libtool_files() { ! find "$plugindir" -name '*.la' | grep .; }

plugindir=${DESTDIR:-}$(pkg-config --define-variable=pc_sysrootdir= --variable=plugindir gamut)
try 'pkg-config knows gamut' pkg-config --exists gamut
try 'the command starts' "$GAMUT" list
try 'every installed plugin is found' lists_every_plugin
try 'no .la files beside the plugins' no_libtool_files
try '<gamut/plugin.h> compiles' header_compiles
try 'an installed scene is sound' "$GAMUT" check "$pkgdatadir/inputs/taylor_bar.yaml"
try_digests
for kind in eos strength elasticity effect random_field estimator solver; do
  try "a new $kind plugin builds and passes" new_plugin "$kind"
done
try 'the plugin guide can be followed' "${PYTHON:-python3}" "${0%/*}/../guide/follow.py"
echo "1..$number"
exit "$((failures > 0))"
