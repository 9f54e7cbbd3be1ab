# Sourced by scripts that try gaitpad in a clean Debian 12 (mmdebstrap; root and a mirror are needed): make_debian
# [PACKAGE...] makes it in $debian, `inside COMMAND` runs there, `part NAME COMMAND` runs and times, print_parts prints
# the times. $work is removed at the end.
if [ "$(id -u)" -ne 0 ]; then
  echo "$(basename "$0"): a chroot needs root: sudo bash tools/$(basename "$0")" >&2
  exit 1
fi
work=$(mktemp -d)
debian=$work/debian
finish() {
  status=$?
  umount "$debian/proc" 2>/dev/null || true
  rm -rf --one-file-system "$work"
  exit $status
}
trap finish EXIT

parts=
part() {
  local name=$1 started=$SECONDS
  shift
  echo "== $name"
  "$@"
  parts+=$(printf '%-44s %5d s' "$name" $((SECONDS - started)))$'\n'
}
print_parts() {
  printf '\n%s%-44s %5d s\n' "$parts" "whole run" "$SECONDS"
}

inside() {
  chroot "$debian" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root XDG_CACHE_HOME=/tmp/cache LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive "$@"
}
make_debian() {
  local packages=(ca-certificates "$@")
  mmdebstrap --quiet --variant=minbase --include="$(IFS=,; echo "${packages[*]}")" bookworm "$debian"
  mount -t proc proc "$debian/proc"
  inside apt-get -qq update
}
