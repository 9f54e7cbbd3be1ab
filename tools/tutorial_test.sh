#!/usr/bin/env bash
# tutorial_test.sh: follows docs/tutorial.md from its first line to its last in a clean Debian 12 without a display,
# from a clone of this repository's last commit. Windows draw a few frames without a display and end; there is no
# player, so the bundled recording replaces the user's, as the page allows. Needs root and a Debian mirror; the last
# lines are each part's seconds.
set -euo pipefail
cd "$(dirname "$0")/.."
bash tools/install.sh mmdebstrap git
source tools/clean_debian.sh

clone() {
  git clone --quiet --bare . "$debian/root/gaitpad.git"
  inside git clone --quiet /root/gaitpad.git /root/gaitpad
}
in_clone() {
  inside env SDL_VIDEODRIVER=offscreen bash -c "cd /root/gaitpad && $1"
}
# Each command of the page as tests/docs_test.py runs it, with its allowed exit statuses.
list_commands() {
  /usr/bin/python3 - <<'PYTHON'
import pathlib, sys
sys.path.insert(0, "tests")
import docs_test
page = pathlib.Path("docs/tutorial.md")
for statement in [s for block in docs_test.blocks_of(page) for s in docs_test.statements_of(block)]:
    if docs_test.is_command(statement):
        script, statuses = docs_test.ended(statement)
        print(" ".join(map(str, statuses)), script, sep="\t", end="\0")
PYTHON
}
follow_page() {
  local statuses script status
  while IFS=$'\t' read -r -d '' statuses script <&3; do
    echo "\$ $script"
    status=0
    in_clone "$script" </dev/null || status=$?
    [[ " $statuses " == *" $status "* ]] || { echo "ended with $status" >&2; return 1; }
  done 3< <(list_commands)
  in_clone "ls -l out/limp out/limp.png out/limp.mp4"
}

part "a clean Debian 12 with git" make_debian git
part "clone" clone
part "bash tools/run.sh" in_clone "bash tools/run.sh"
part "ffmpeg, for the video" inside sh -c 'apt-get -qq install -y --no-install-recommends ffmpeg >/dev/null'
part "every other command of the page" follow_page
print_parts
