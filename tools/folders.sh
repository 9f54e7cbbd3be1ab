# Sourced with `root` set: says in `build` where to build and in `out` where results go. Inside the
# repository, unless GAITPAD_BUILD names another folder or the repository cannot be written; then
# below the user's cache.
if [ -n "${GAITPAD_BUILD:-}" ]; then
  mkdir -p "$GAITPAD_BUILD"
  build=$(cd "$GAITPAD_BUILD" && pwd)
  out=$build/out
elif [ -w "$root" ]; then
  build=$root/build
  out=$root/out
else
  build=${XDG_CACHE_HOME:-$HOME/.cache}/gaitpad/build-$(cksum <<<"$root" | cut -d ' ' -f 1)
  out=$build/out
  echo "$root cannot be written: building in $build, results go to $out" >&2
fi
