# Digests of installed plugins, for the tests of what is installed: with `try`, $scratch, $GAMUT and
# $plugindir.
# shellcheck disable=SC2154

# Each shared object of each plugin has one, and it is right; they need no hand to be checked.
each_has_a_digest()
{
  local object count=0
  for object in "$plugindir"/*/*/*.so; do
    (cd "${object%/*}" && sha256sum -c "${object##*/}.sha256") || return 1
    count=$((count + 1))
  done
  [ "$count" -ge 20 ]
}

# A copy of the installed plugins, which stands in front of them.
copy_plugins()
{
  rm -rf "$scratch/copy" && cp -r "$plugindir" "$scratch/copy" && chmod -R u+w,go-w "$scratch/copy"
}

# evaluates STATUS PATTERN: a law of the copy, which ends with STATUS and says PATTERN.
evaluates()
{
  local status=0
  GAMUT_LEVEL=baseline "$GAMUT" --plugin-path "$scratch/copy" --no-user-plugins eval eos/linear \
    --param bulk_modulus=1e9 --at compression=0.1 --at reference_density=1000 \
    >"$scratch/said" 2>&1 || status=$?
  cat "$scratch/said"
  [ "$status" -eq "$1" ] && grep -qE -- "$2" "$scratch/said"
}

damaged()
{
  local object=$scratch/copy/eos/linear/linear.so size
  copy_plugins || return 1
  size=$(stat -c %s "$object")
  case $1 in
    flipped)
      printf '\x5a' | dd of="$object" bs=1 seek=$((size / 2)) conv=notrunc status=none
      if cmp -s "$object" "$plugindir/eos/linear/linear.so"; then
        printf '\xa5' | dd of="$object" bs=1 seek=$((size / 2)) conv=notrunc status=none
      fi
      ;;
    truncated) truncate -s $((size * 9 / 10)) "$object" ;;
    digest) echo 'no digest' >"$object.sha256" ;;
  esac
}

refuses()
{
  damaged "$1" && evaluates 4 "$2"
}

whole() { copy_plugins && evaluates 0 pressure; }

try_digests()
{
  local sum='[0-9a-f]{64}'
  try 'each shared object has its digest' each_has_a_digest
  try 'a copy of the plugins opens' whole
  try 'a flipped byte is refused' refuses flipped \
    "linear.so' is not the file that was installed: its SHA-256 is $sum, .* says $sum"
  try 'a cut-off file is refused' refuses truncated \
    "linear.so' is not the file that was installed: its SHA-256 is $sum, .* says $sum"
  try 'a broken digest is refused' refuses digest "linear.so.sha256' holds no digest"
}
