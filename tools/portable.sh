#!/usr/bin/env bash
# portable.sh libc++|aarch64|wasm|scalar [FOLDER]: compiles the core and a program that walks with it for another standard
# library, processor or machine, and prints what the program prints: a hash of each second of each walk, the same everywhere
# (tests/tools/portable_test.py). libc++: clang++ and LLVM's library, with gaitpad::files. aarch64: g++, run by qemu.
# wasm: Emscripten, run by node. scalar: g++ without vector types, as for a compiler that has none. Objects are kept in FOLDER
# (build-portable/KIND).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
kind=${1:-}
folder=${2:-build-portable/$kind}
walk=$folder/walk.js # a program all the same; em++ goes by the ending
files=()
case $kind in
  libc++)
    bash tools/install.sh clang libc++-dev libc++abi-dev
    # The system's fmt and toml++ are built with another standard library; their headers are not.
    compile=(clang++ -stdlib=libc++ -DGAITPAD_HAS_FILES -DFMT_HEADER_ONLY -DTOML_HEADER_ONLY=1 -pthread)
    link=(-lpng)
    run=()
    files=(src/system/*.cpp src/files/*.cpp)
    ;;
  aarch64)
    bash tools/install.sh g++-aarch64-linux-gnu qemu-user-static
    compile=(aarch64-linux-gnu-g++ -pthread)
    link=(-static)
    run=(qemu-aarch64-static)
    ;;
  wasm)
    bash tools/install.sh emscripten
    export NODE_PATH=/usr/share/nodejs # Debian's modules, which a node of another source does not look for
    # One file, for newer versions of node cannot fetch() another one from the disk.
    compile=(em++)
    link=(-sSINGLE_FILE=1 -sALLOW_MEMORY_GROWTH=1)
    run=(node)
    ;;
  scalar)
    bash tools/install.sh
    compile=(g++ -DGAITPAD_NO_VECTORS -pthread)
    link=()
    run=()
    ;;
  *)
    echo "usage: bash tools/portable.sh libc++|aarch64|wasm|scalar [FOLDER]" >&2
    exit 2
    ;;
esac
mkdir -p "$folder/include"
# Headers without code of GLM and Eigen; the other headers in /usr/include are this machine's own.
ln -sfn /usr/include/glm "$folder/include/glm"
ln -sfn /usr/include/eigen3/Eigen "$folder/include/Eigen"
compile+=(-std=c++20 -O2 -w -ffp-contract=off -fno-tree-slp-vectorize -fno-math-errno -Isrc -Isrc/include -I. -isystem "$folder/include")

objects=()
{
  printf 'builddir = %s\n' "$folder" # for the log of ninja
  printf 'rule compile\n  command = %s -MD -MF $out.d -c $in -o $out\n  depfile = $out.d\n' "${compile[*]}"
  for source in src/{base,motion,strides,control,animation,walk}/*.cpp "${files[@]}" tests/walk/core_hash_main.cpp; do
    object=${source//\//_}.o
    [[ " ${objects[*]} " != *" $object "* ]] || continue
    objects+=("$object")
    printf 'build %s: compile %s\n' "$folder/$object" "$source"
  done
  printf 'rule link\n  command = %s $in %s -o $out\n' "${compile[*]}" "${link[*]}"
  printf 'build %s: link %s\n' "$walk" "${objects[*]/#/$folder/}"
} >"$folder/build.ninja"
nice -n 15 ninja -j1 -f "$folder/build.ninja" >"$folder/build.log" || {
  cat "$folder/build.log" >&2
  exit 1
}
"${run[@]}" "$walk"
