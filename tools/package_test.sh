#!/usr/bin/env bash
# package_test.sh [FOLDER]: makes the Debian packages in FOLDER (default: build-package) and tries them: lintian,
# desktop-file-validate and appstreamcli find no fault; in a clean Debian 12 (mmdebstrap) they install with their
# dependencies, `gaitpad replay` gives the build's poses, the manual and the completions are present, a project builds
# against libgaitpad-dev, and removing them leaves nothing. Needs root and a Debian mirror; a few minutes. The last
# lines are the seconds of each part.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
folder=${1:-build-package}
source tools/clean_debian.sh

install_tools() {
  bash tools/install.sh dpkg-dev fakeroot lintian desktop-file-utils appstream mmdebstrap
}
make_packages() {
  rm -f "$folder"/*.deb
  bash tools/build.sh "$folder" all -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DGAITPAD_TESTS=OFF \
    -DGAITPAD_CONFIG_DIR=
  (cd "$folder" && cpack -G DEB)
  ls -l "$folder"/*.deb
}
judge_packages() {
  # A package that is not in Debian closes no bug there.
  lintian --allow-root --fail-on error,warning --suppress-tags initial-upload-closes-no-bugs "$folder"/*.deb
  dpkg-deb --extract "$folder"/gaitpad_*.deb "$work/program"
  desktop-file-validate "$work"/program/usr/share/applications/*.desktop
  appstreamcli validate --no-net "$work"/program/usr/share/metainfo/*.xml
}

# The files of the chroot, without the records of apt and dpkg.
files() {
  (cd "$debian" && find . -xdev \( -path ./proc -o -path ./packages -o -path ./tmp -o -path ./var/lib/dpkg \
    -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log \) -prune -o -print | sort)
}
make_chroot() {
  make_debian
  # A minimal Debian may leave out manuals; this one is to have them.
  rm -f "$debian"/etc/dpkg/dpkg.cfg.d/*docker* "$debian"/etc/dpkg/dpkg.cfg.d/*excludes*
  mkdir -p "$debian/packages"
  cp "$folder"/*.deb "$debian/packages"
  files >"$work/before"
}
install_program() {
  inside sh -c 'apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends /packages/gaitpad_*.deb' >/dev/null
  inside gaitpad --version
}
try_program() {
  inside gaitpad replay /usr/share/gaitpad/traces/round.hid --style limp_left --out /tmp/out
  inside gaitpad calibrate --trace /usr/share/gaitpad/traces/worn.hid --out /tmp/worn.toml --plot /tmp/worn.png >/dev/null
  inside gaitpad check --update /tmp/out/none 2>/dev/null && return 1
  local there here
  there=$(inside gaitpad replay /usr/share/gaitpad/traces/round.hid --style limp_left --json)
  here=$("$folder/gaitpad" replay config/traces/round.hid --style limp_left --json)
  [ "$there" = "$here" ] || { echo "the installed program walks another way: $there" >&2; return 1; }
  for file in lib/udev/rules.d/60-gaitpad.rules share/man/man1/gaitpad.1.gz share/man/man1/gaitpad-check.1.gz \
    share/bash-completion/completions/gaitpad share/zsh/vendor-completions/_gaitpad \
    share/fish/vendor_completions.d/gaitpad.fish share/applications/io.github.gaitpad.gaitpad.desktop \
    share/icons/hicolor/scalable/apps/io.github.gaitpad.gaitpad.svg \
    share/metainfo/io.github.gaitpad.gaitpad.metainfo.xml share/doc/gaitpad/copyright; do
    [ -f "$debian/usr/$file" ] || { echo "/usr/$file is missing" >&2; return 1; }
  done
  inside gaitpad doctor || true  # a chroot has no pad; it is to end by itself
}
install_library() {
  inside sh -c 'apt-get -qq -o Dpkg::Use-Pty=0 install -y --no-install-recommends /packages/libgaitpad*.deb cmake g++ make' >/dev/null
}
try_library() {
  cp -r tools/examples "$debian/tmp/examples"
  mkdir -p "$debian/tmp/examples/walks"
  cp config/traces/round.hid "$debian/tmp/examples/walks"
  printf 'enable_testing()\ngaitpad_add_trace_tests(walks)\n' >>"$debian/tmp/examples/CMakeLists.txt"
  inside gaitpad check --update /tmp/examples/walks
  inside cmake -S /tmp/examples -B /tmp/built >/dev/null
  inside cmake --build /tmp/built
  inside sh -c '/tmp/built/solve_leg && /tmp/built/minimal_walk /tmp/out/pose.bvh 0.8 | tail -n 1 && /tmp/built/walk_in_c | tail -n 1'
  inside ctest --test-dir /tmp/built --output-on-failure
}
remove_all() {
  inside sh -c 'apt-get -qq -o Dpkg::Use-Pty=0 purge -y gaitpad libgaitpad-dev libgaitpad0 cmake g++ make && apt-get -qq -o Dpkg::Use-Pty=0 autoremove --purge -y' >/dev/null
  files >"$work/after"
  diff "$work/before" "$work/after" && echo "nothing is left"
}

part "tools" install_tools
part "packages (build and cpack)" make_packages
part "lintian and validators" judge_packages
part "a clean Debian 12" make_chroot
part "gaitpad installed" install_program
part "gaitpad walks" try_program
part "libgaitpad-dev installed" install_library
part "examples built and recordings as tests" try_library
part "removed without a trace" remove_all
print_parts
