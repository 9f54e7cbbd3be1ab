#!/usr/bin/env bash
# Tests data that threads share (rings, the newest frame, pads plugged in and out, the loop, the recorder) under
# ThreadSanitizer. Any report is a failure.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
bash "$root/tools/install.sh"
bash "$root/tools/build.sh" "$root/build-tsan" test_threads -DGAITPAD_TSAN=ON \
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG="-O1 -g1"
export TSAN_OPTIONS="halt_on_error=0 exitcode=66 history_size=4 ${TSAN_OPTIONS:-}"
bash "$root/tools/ctest.sh" "$root/build-tsan" -R '^threads\.'
