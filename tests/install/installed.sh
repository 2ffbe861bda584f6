# What `make installcheck` asks of an installed gamut: it finds its plugins, and a stranger's plugin
# of each kind, written by `gamut new`, builds with nothing but pkg-config and passes `verify`.
set -u
number=0
failures=0
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset GAMUT_PLUGIN_PATH MAKEFLAGS MAKELEVEL MFLAGS
: "${GAMUT:?}" "${prefix:?}" "${libdir:?}" "${includedir:?}" "${pkgdatadir:?}"
unset PKG_CONFIG_SYSROOT_DIR
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

# As a user who moves the tree, or unpacks it elsewhere: a copy, since this one stays.
moved=$scratch/moved
moves()
{
  local part
  for part in bin/gamut "${libdir#"$prefix"/}"/libgamut.* "${libdir#"$prefix"/}/gamut" \
    "${libdir#"$prefix"/}/pkgconfig/gamut.pc" "${includedir#"$prefix"/}/gamut" \
    "${pkgdatadir#"$prefix"/}"; do
    mkdir -p "$moved/${part%/*}" && cp -a "$prefix"/$part "$moved/${part%/*}" || return 1
  done
}

# Each folder that pkg-config tells lies in the moved tree.
moved_folders()
{
  local name told
  for name in prefix bindir libdir includedir plugindir gamut; do
    told=$(realpath -e "$(pkg-config --variable=$name gamut)") || return 1
    case $told/ in "$(realpath "$moved")"/*) ;; *) echo "$name is $told"; return 1 ;; esac
  done
}

# A stranger's program builds against the library there, and checks a scene with its plugins.
embeds()
{
  cat >"$scratch/embeds.c" <<'END'
#include <gamut/gamut.h>
#include <stdio.h>
int main(int count, char **argument)
{
  struct gamut_session *session = gamut_session_new(argument[1]);
  gamut_status status = gamut_check_scene(session, argument[count - 1], NULL);
  fputs(gamut_messages(session), stderr);
  gamut_session_free(session);
  return (int)status;
}
END
  # shellcheck disable=SC2046,SC2086 # lists of flags
  ${CC:-cc} -o "$scratch/embeds" "$scratch/embeds.c" $(pkg-config --cflags --libs gamut) &&
    LD_LIBRARY_PATH=$(pkg-config --variable=libdir gamut) "$scratch/embeds" \
      "$(realpath "$(pkg-config --variable=plugindir gamut)")" \
      "$moved/${pkgdatadir#"$prefix"/}/inputs/taylor_bar.yaml"
}

plugindir=$(pkg-config --variable=plugindir gamut)
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
case $libdir/ in
  "$prefix"/*)
    try 'the tree is moved' moves
    export PKG_CONFIG_PATH=$moved/${libdir#"$prefix"/}/pkgconfig
    try 'pkg-config tells folders of the moved tree' moved_folders
    try 'a program builds and runs against it' embeds
    ;;
  *)
    number=$((number + 1))
    echo "ok $number - the tree is moved # SKIP libdir is not below prefix"
    ;;
esac
echo "1..$number"
exit "$((failures > 0))"
