# What is installed takes listed files only, and finds its plugins and cards where it stands: at
# another prefix than configure was told, and after it was moved.
# shellcheck disable=SC2154 # GAMUT, srcdir and builddir come from the harness
set -u
number=0
failures=0
scratch=$(mktemp -d) || exit 1
trap 'rm -rf "$scratch"' EXIT
unset GAMUT_PLUGIN_PATH MAKEFLAGS MAKELEVEL MFLAGS DESTDIR
export XDG_DATA_HOME=$scratch/none
cd "$scratch" || exit 1
# shellcheck source=digests.sh
. "$srcdir/tests/install/digests.sh"

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

# The folder that plugins come from is below PREFIX, and all of the tree's plugins are in it.
plugins_of()
{
  "$1/bin/gamut" list --paths >paths || return 1
  grep -F "$1/lib" paths || { cat paths; return 1; }
  "$1/bin/gamut" list | grep -v '^in ' >there
  "$GAMUT" list | grep -v '^in ' | diff there -
}

# A scene elsewhere that includes a card which only the installed gamut has.
finds_cards()
{
  mkdir -p elsewhere
  sed 's/^title.*/title: installed/' "$srcdir/inputs/taylor_bar.yaml" >elsewhere/scene.yaml
  "$1/bin/gamut" check elsewhere/scene.yaml
}

installs() { make -C "$builddir" install prefix="$scratch/first"; }

moves() { mv first second; }

only_listed()
{
  (cd "$scratch/first/share/gamut" && find inputs -type f | sort) >installed
  tr -d '\\' <"$srcdir/inputs/Makefile.inc" | tr ' ' '\n' | grep '\.yaml$' | sort >listed
  diff installed listed
}

# A stray file in the tree stays where it is: a copy of the tree's folders, so as to leave none
# there.
no_strays()
{
  mkdir stray && ln -s "$srcdir"/* stray && rm stray/inputs stray/docs stray/plugins || return 1
  cp -rp "$srcdir/inputs" "$srcdir/docs" "$srcdir/plugins" stray || return 1
  touch stray/inputs/stray.yaml stray/docs/stray.log stray/plugins/eos/linear/stray.yaml
  make -C "$builddir" install-data-local install-plugins srcdir="$scratch/stray" \
    prefix="$scratch/third" || return 1
  [ -f third/share/gamut/inputs/sod.yaml ] || return 1
  ! find third -name 'stray*' | grep .
}

try 'make install prefix=..' installs
try 'it takes the scenes and cards that are listed' only_listed
try 'and nothing that was left in the tree' no_strays
try 'plugins are found at that prefix' plugins_of "$scratch/first"
try 'cards are found at that prefix' finds_cards "$scratch/first"
try 'the tree is moved' moves
try 'plugins are found after the move' plugins_of "$scratch/second"
try 'cards are found after the move' finds_cards "$scratch/second"
ln -s "$scratch/second/bin/gamut" "$scratch/gamut"

try 'and through a link' "$scratch/gamut" check elsewhere/scene.yaml

# The plugins stay at the place that configure was told; what is here is uninstalled there.
# shellcheck disable=SC2034 # of digests.sh
plugindir=$(echo "$scratch"/second/lib*/gamut/plugins)
GAMUT=$scratch/second/bin/gamut
try_digests
uninstalls()
{
  make -C "$builddir" uninstall prefix="$scratch/second" && ! find second -type f | grep .
}
try 'make uninstall leaves no file' uninstalls
echo "1..$number"
exit "$((failures > 0))"
