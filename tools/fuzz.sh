#!/usr/bin/env bash
# fuzz.sh [SECONDS]: builds the fuzz targets with clang and runs each for that long (default 60).
# The corpus stays in build-fuzz/corpus. An input that breaks a target is kept in build-fuzz and named.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
seconds=${1:-60}
build=$root/build-fuzz
bash "$root/tools/install.sh" libclang-rt-14-dev
bash "$root/tools/build.sh" "$build" fuzzers -DGAITPAD_FUZZ=ON -DCMAKE_CXX_COMPILER=clang++ \
  -DCMAKE_BUILD_TYPE=Release
/usr/bin/python3 "$root/tools/fuzz/seeds.py" "$build/seeds"

for name in fuzz_descriptor fuzz_trace fuzz_bvh fuzz_acclaim fuzz_calibration fuzz_import fuzz_terrain; do
  mkdir -p "$build/corpus/$name"
  log=$build/$name.log
  if ! "$build/tools/fuzz/$name" -max_total_time="$seconds" -timeout=10 -max_len=16384 \
    -artifact_prefix="$build/$name-" "$build/corpus/$name" "$build/seeds/$name" >"$log" 2>&1; then
    tail -n 30 "$log" >&2
    exit 1
  fi
  echo "$name: $(grep -E '^Done' "$log")"
done
