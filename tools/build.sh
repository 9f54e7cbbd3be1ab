#!/usr/bin/env bash
# build.sh FOLDER TARGET [CMAKE OPTION...]: configures and builds into FOLDER; silent unless it fails. On a terminal, a
# line shows the progress after two seconds.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
folder=$1 target=$2
shift 2
mkdir -p "$folder"
log=$folder/build.log

options=(-G Ninja -DCMAKE_UNITY_BUILD=ON "$@")
# If ccache is installed, its cache serves every checkout of the repository.
command -v ccache >/dev/null && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1
# Run CMake only the first time: ninja reruns it when a CMakeLists.txt or a folder changes.
if [ ! -f "$folder/build.ninja" ]; then
  echo "Building into $folder (a few minutes the first time)" >&2
  if ! cmake -S "$root" -B "$folder" "${options[@]}" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$folder/CMakeCache.txt"
    exit 1
  fi
fi
# ninja's "[12/171] Building ..." as percent and time left, on a line that is rewritten.
show_progress() {
  [ -t 2 ] || exec cat >/dev/null
  local line start=$SECONDS
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
    local built=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} spent=$((SECONDS - start))
    [ "$spent" -ge 2 ] || continue
    printf '\rBuilding: %d %%, %d s left \033[K' $((100 * built / all)) $((spent * (all - built) / built)) >&2
  done
  printf '\r\033[K' >&2
}
if ! cmake --build "$folder" --target "$target" 2>&1 | tee "$log" | show_progress; then
  grep -v '^\[[0-9/]*\] Building\|^\[[0-9/]*\] Linking' "$log" >&2
  exit 1
fi
