#!/usr/bin/env bash
# fuzz.sh [SECONDS | --hours N] [TARGET...]: builds the fuzz targets with clang and runs each for that long (default
# 60), or all in turn, a minute each, until N hours are over; always on one core. They start from the inputs in
# tools/fuzz/corpus and those found earlier in build-fuzz/corpus. The table at the end counts all executions in
# build-fuzz so far; `tools/measured.py fuzz` puts it into docs/measured.md. An input that breaks a target is kept in
# build-fuzz and named. fuzz.sh --keep [TARGET...]: writes the fewest inputs that reach all edges found so far to
# tools/fuzz/corpus.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build-fuzz kept=$root/tools/fuzz/corpus executed=$root/build-fuzz/executed.tsv
seconds=60 rounds_s=0 keeps=
case ${1:-} in
  --hours)
    rounds_s=$(awk -v hours="${2:-}" 'BEGIN { print int(3600 * hours) }')
    [ "$rounds_s" -gt 0 ] || { echo "fuzz.sh: --hours needs a number above 0" >&2; exit 2; }
    shift 2
    ;;
  --keep)
    keeps=1
    shift
    ;;
  [0-9]*)
    seconds=$1
    shift
    ;;
esac
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for source in "$root"/tools/fuzz/fuzz_*.cpp; do targets+=("$(basename "$source" .cpp)"); done
fi
# Greatest size of a target's input, bytes: longer text only repeats itself.
declare -A most=([fuzz_command]=1024 [fuzz_stream]=1024 [fuzz_session]=1024 [fuzz_mapping]=2048 [fuzz_expectation]=4096 [fuzz_pad_file]=4096)

bash "$root/tools/install.sh" libclang-rt-14-dev xz-utils
for target in "${targets[@]}"; do
  bash "$root/tools/build.sh" "$build" "$target" -DGAITPAD_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++ -DCMAKE_BUILD_TYPE=Release
done
/usr/bin/python3 "$root/tools/fuzz/seeds.py" "$build/seeds"

# run TARGET SECONDS: appends the number of executions and edges to the table; false if an input broke it.
run() {
  local target=$1 log=$build/$1.log status=0
  mkdir -p "$build/corpus/$target"
  if [ -f "$kept/$target.tar.xz" ]; then tar -xJf "$kept/$target.tar.xz" -C "$build/corpus/$target"; fi
  "$build/tools/fuzz/$target" -max_total_time="$2" -timeout=30 -max_len="${most[$target]:-16384}" -print_final_stats=1 \
    -artifact_prefix="$build/$target-" "$build/corpus/$target" "$build/seeds/$target" >"$log" 2>&1 || status=$?
  awk -v target="$target" -v seconds="$2" -v OFS='\t' '
    match($0, / cov: [0-9]+/) { edges = substr($0, RSTART + 6, RLENGTH - 6) }
    /^stat::number_of_executed_units:/ { print target, seconds, $2, edges }' "$log" >>"$executed"
  [ $status -eq 0 ] || tail -n 30 "$log" >&2
  return $status
}

# Keeps each input of the folder that reaches an edge which the earlier ones do not reach.
keep() {
  local target=$1 few=$build/few/$1
  rm -rf "$few"
  mkdir -p "$few" "$kept"
  "$build/tools/fuzz/$target" -merge=1 -timeout=10 "$few" "$build/corpus/$target" "$build/seeds/$target" \
    >"$build/$target.log" 2>&1
  tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -C "$few" -cf - . | xz -9 >"$kept/$target.tar.xz"
  echo "$target: $(find "$few" -type f | wc -l) inputs, $(stat -c %s "$kept/$target.tar.xz") bytes packed"
}

if [ -n "$keeps" ]; then
  for target in "${targets[@]}"; do keep "$target"; done
  exit
fi
broken=()
end=$((SECONDS + rounds_s))
while :; do
  for target in "${targets[@]}"; do
    case " ${broken[*]} " in *" $target "*) continue ;; esac
    run "$target" "$seconds" || broken+=("$target")
    [ $rounds_s -eq 0 ] || [ $SECONDS -lt $end ] || break
  done
  if [ $SECONDS -ge $end ] || [ ${#broken[@]} -eq ${#targets[@]} ]; then break; fi
done
awk -F '\t' '{ runs[$1] += $3; time[$1] += $2; if ($4 > edges[$1]) edges[$1] = $4; all += $3 }
  END {
    printf "%-20s %14s %10s %8s\n", "target", "executions", "minutes", "edges"
    for (t in runs) printf "%-20s %14d %10.1f %8d\n", t, runs[t], time[t] / 60, edges[t] | "sort"
    close("sort")
    printf "%-20s %14d\n", "all", all
  }' "$executed"
if [ ${#broken[@]} -gt 0 ]; then
  echo "fuzz.sh: an input broke ${broken[*]}; it is kept in $build" >&2
  exit 1
fi
