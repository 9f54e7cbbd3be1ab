#!/usr/bin/env bash
# check.sh [--all | --since COMMIT | --recent | --slice N | --most N | FILE.cpp ...]: checks the layout of every C++ file
# (clang-format 14) and runs clang-tidy 14 with the checks of .clang-tidy over the sources that changed since COMMIT,
# default: since main. --recent: since the newest commit that is a day older than the last one. --slice N: also over
# every N-th source; the commit chooses the first one (slice.sh). --most N: where these are more than N, over every
# second or third ... of them, so that a day that changes a whole folder does not fill its run. --all, or
# GAITPAD_ALL=1: over all sources, half an hour of processor time. --format: only the layout.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
all=${GAITPAD_ALL:-0} tidy=1 since= slice=0 most=0 files=()
while [ $# -gt 0 ]; do
  case $1 in
    --all) all=1 ;;
    --format) tidy=0 ;;
    --since)
      since=${2:?check.sh: --since needs a commit}
      shift
      ;;
    --recent) since=$(git rev-list -1 --before="$(($(git log -1 --format=%ct) - 86400))" HEAD) ;;
    --slice)
      slice=${2:?check.sh: --slice needs a number}
      shift
      ;;
    --most)
      most=${2:?check.sh: --most needs a number}
      shift
      ;;
    -*)
      echo "check.sh: unknown option $1" >&2
      exit 2
      ;;
    *) files+=("$1") ;;
  esac
  shift
done

source tools/slice.sh
bash tools/install.sh clang-format clang-tidy
# /usr/bin: the versions of Debian 12, whatever else is on PATH.
git ls-files -z '*.cpp' '*.h' '*.c' | xargs -0 /usr/bin/clang-format --dry-run -Werror
# Lists and tables in comments keep their layout (.clang-format), so only this bounds their width.
git ls-files -z '*.cpp' '*.h' '*.c' | xargs -0 awk '/\/\// && length > 100 {
  print FILENAME ":" FNR ": a comment of more than 100 columns"; wide = 1 } END { exit wide }'
[ $tidy -eq 1 ] || exit 0

sources() { git ls-files 'src/*.cpp' 'drivers/*.cpp' 'tools/*.cpp' ':!tools/fuzz' ':!tools/examples'; }
# Changed sources, and for each changed header the first source that includes it.
changed_sources() {
  local name header
  while read -r name; do
    [ -f "$name" ] || continue
    case $name in
      src/*.cpp | drivers/*.cpp | tools/*.cpp) echo "$name" ;;
      src/*.h | drivers/*.h)
        header=${name#src/}
        header=${header#include/}
        sources | xargs grep -lF "\"$header\"" 2>/dev/null | head -n 1 || true
        ;;
    esac
  done < <(git diff --name-only "$1")
}
if [ $all -eq 1 ]; then
  mapfile -t files < <(sources)
elif [ ${#files[@]} -eq 0 ]; then
  if [ -z "$since" ] && [ "$slice" -eq 0 ]; then
    for branch in origin/main main; do
      since=$(git merge-base HEAD "$branch" 2>/dev/null) && break
    done
  fi
  [ -n "$since" ] || since=HEAD
  sliced() {
    [ "$slice" -eq 0 ] || sources | awk -v n="$slice" -v first=$((GAITPAD_SLICE % slice)) 'NR % n == first'
  }
  mapfile -t files < <({ changed_sources "$since"; sliced; } | sort -u | grep -Fxf <(sources) || true)
  if [ "$most" -gt 0 ] && [ ${#files[@]} -gt "$most" ]; then
    every=$(((${#files[@]} + most - 1) / most))
    echo "clang-tidy: ${#files[@]} sources changed, of which the commit chooses one in $every" >&2
    mapfile -t files < <(printf '%s\n' "${files[@]}" | awk -v n=$every -v first=$((GAITPAD_SLICE % every)) 'NR % n == first')
  fi
fi
if [ ${#files[@]} -eq 0 ]; then
  echo "clang-tidy: no source changed"
  exit 0
fi

build=$root/build-tidy
if [ ! -f "$build/compile_commands.json" ] ||
  [ -n "$(find . -name CMakeLists.txt -newer "$build/compile_commands.json" -not -path './build*' -print -quit)" ]; then
  mkdir -p "$build"
  cmake -S . -B "$build" -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON >"$build/build.log" 2>&1 || {
    cat "$build/build.log" >&2
    exit 1
  }
  touch "$build/compile_commands.json"
fi
# Sources outside the configuration (a driver without its library) have no compile command and are not checked.
mapfile -t known < <(printf '%s\n' "${files[@]}" | while read -r name; do
  grep -qF "\"file\": \"$root/$name\"" "$build/compile_commands.json" && echo "$name"; done)
[ ${#known[@]} -gt 0 ] || { echo "clang-tidy: none of these sources is built here"; exit 0; }
export build
check_one() {
  local out
  out=$(/usr/bin/clang-tidy -p "$build" --quiet "$1" 2>/dev/null) && return 0
  grep -E 'error:|warning:' <<<"$out" | sort -u >&2
  return 1
}
export -f check_one
status=0
printf '%s\0' "${known[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'check_one "$1"' check || status=1
echo "clang-tidy: ${#known[@]} sources looked at"
exit $status
