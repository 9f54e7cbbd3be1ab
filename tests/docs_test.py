#!/usr/bin/python3
"""The pages hold together: lengths, links, names of files, the measured page is the script's, and every command works.

Commands are read from the pages' blocks of code and run in order, each page in a folder of its own that looks like the
repository after `bash tools/run.sh`: the README's always, the other pages' in slices. A command that an earlier page had
runs again only where its page needs what it writes. What waits for a person ends after a moment: windows draw a few
frames without a display, live pads are waited for a second.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

from support import pages, slices

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), ROOT / "config" / "README.md",
                *ROOT.glob("src/*/README.md"), *ROOT.glob("drivers/README.md")])
NAMED = re.compile(r"`((?:src|drivers|tools|tests|config|docs)/[A-Za-z0-9_./*]+)`")
PLACEHOLDERS = {"tests/data/pads/VVVV_PPPP.hid"}


# What the pages name and neither the sources nor the program's help have, and why. With a page: only there.
FOREIGN = {
    # Examples of the style guide.
    "SmallerWeightTurnsThatJointLess|stride_length_m|ankle_world_m|PascalCase|snake_case|trailing_|"
    "Reject truncated report descriptors": "shows how to name things",
    # What the reader makes.
    r"tests/data/pads/VVVV_PPPP\.hid": "VVVV and PPPP are the pad's ids",
    r"walk_01(_02)?\.(asf|amc)": "a captured motion of the reader's",
    r"(FOLDER/)?walks/.*|\.github/workflows/walks\.yml|sbatch walks\.sbatch": "another project's recordings and jobs",
    r"out/my_walk\.toml": "the tutorial writes it",
    # Other programs, libraries and standards.
    r"ffe5:[13]000": "HID usages that the kernel's hid-input makes up",
    "std::experimental::simd": "what src/walk/lanes.h replaces",
    "HumanBodyBones": "Unity's names of bones",
    r"Skeleton3D|Transform3D|JSON\.parse_string": "Godot's types and functions",
    "SDL_GAMECONTROLLER_IGNORE_DEVICES=0x054c/0x09cc|SDL_NO_SIGNAL_HANDLERS": "SDL's names of hints",
    "hid_open": "hidapi's function",
    "MCL_FUTURE": "a flag of mlockall() that is not used",
    "-ffast-math": "a compiler's option that is not used",
    "ssh( -X)?": "the shell's",
    # Captured motions and recordings, which are no part of the repository.
    r"cmu_m21_\*|cmu_006_01|git grep cmu_": "names of motions in the data folder",
    r"docs/data\.md: [\w.-]+/[\w.-]+": "where the data come from: repositories on GitHub",
}


def text_of(page):
    """The page without its blocks of code."""
    return re.sub(r"^```.*?^```", "", page.read_text(), flags=re.S | re.M)


def test_the_readme_is_short():
    text = (ROOT / "README.md").read_text()
    assert len(text.splitlines()) <= 130 and len(text.split()) <= 920


def test_a_room_is_told_on_a_card():
    for page in [*ROOT.glob("src/*/README.md"), *ROOT.glob("drivers/README.md")]:
        assert len(page.read_text().splitlines()) <= 25, page


def test_links_lead_somewhere():
    for page in PAGES:
        for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text_of(page)):
            assert "://" in link or (page.parent / link).exists(), f"{page}: {link}"


def test_files_that_are_named_exist():
    for page in PAGES:
        if page.name == "CHANGELOG.md":
            continue  # names what was
        for name in set(NAMED.findall(text_of(page))) - PLACEHOLDERS:
            assert list(ROOT.glob(name.rstrip("/"))), f"{page}: {name}"


@pytest.fixture(scope="module")
def judge(program):
    return pages.Judge(program, FOREIGN)


def test_what_is_named_exists(judge):
    """Each function, type, constant, file, command, option and key in backticks, where the page says that it is."""
    faults = [f for page in PAGES if page.name != "CHANGELOG.md" for f in judge.faults_of(page)]
    assert not faults, "\n".join(faults)


def test_every_exception_is_needed(judge):
    text = {page: {span for span, _ in pages.spans_of(page.read_text())} for page in PAGES if page.name != "CHANGELOG.md"}
    for name in FOREIGN:
        assert any(judge.is_foreign(span, page, [name]) for page, spans in text.items() for span in spans), name


def banned_words():
    page = (ROOT / "docs/glossary.md").read_text()
    table = page[page.index("## Words that are not used"):]
    return [word for row in re.findall(r"^\| ([^|]+) \| [^|]+ \|$", table, flags=re.M) for word in row.split(", ")
            if word != "not"]


def test_the_glossary_has_thirty_terms_and_its_banned_words_occur_nowhere():
    page = (ROOT / "docs/glossary.md").read_text()
    assert len(re.findall(r"^\| (?!term|not|---)", page, flags=re.M)) >= 30
    words = re.compile(r"\b(?:" + "|".join(banned_words()) + r")\b", flags=re.I)
    for path in PAGES:
        if path.name not in ("CHANGELOG.md", "glossary.md"):
            assert not (found := words.search(" ".join(text_of(path).split()))), f"{path}: {found.group()}"


def test_the_help_has_no_banned_word(program, tmp_path):
    """The manual pages are made of the help, so they have no banned word either."""
    subprocess.run([program, "__manual", tmp_path], check=True)
    words = re.compile(r"\b(?:" + "|".join(banned_words()) + r")\b", flags=re.I)
    manuals = sorted(tmp_path.glob("*.1"))
    assert len(manuals) > 15
    for manual in manuals:
        assert not (found := words.search(" ".join(manual.read_text().split()))), f"{manual.name}: {found.group()}"


SABOTAGES = [  # page, what it says, what is false
    ("docs/path.md", "`Pads::take_report()`", "`Pads::take_packet()`"),
    ("docs/path.md", "`assign_ticks()`", "`assign_tick()`"),
    ("docs/path.md", "| `src/hid/decode.cpp` |", "| `src/hid/descriptor.cpp` |"),  # another file of the room
    ("docs/path.md", "`src/pads/pad_stream.cpp`", "`src/pads/pad_reader.cpp`"),
    ("docs/path.md", "`GaitParams`", "`GaitParameters`"),
    ("docs/walk.md", "`cycle_on_skeleton()`", "`retargeted_cycle()`"),
    ("docs/walk.md", "`ground_plan.cpp`", "`ground_search.cpp`"),
    ("docs/crowd.md", "`Crowd::advance()`", "`Crowd::step()`"),
    ("docs/pads.md", "`frame_us_p99`", "`frame_ms_p99`"),
    ("docs/pads.md", "`quirks_of()`", "`quirks_for()`"),
    ("docs/pads.md", "`sony.cpp`", "`dualshock.cpp`"),
    ("docs/process.md", "`PadSelector::driver`", "`PadSelector::drivers`"),
    ("docs/library.md", "`gaitpad::session`", "`gaitpad::sitting`"),
    ("docs/ci.md", "`GAITPAD_SHARD_TOTAL`", "`GAITPAD_SHARD_COUNT`"),
    ("docs/ci.md", "`--strict`", "`--severe`"),
    ("docs/replay.md", "`play --commands`", "`play --max-hours`"),  # an option of another command
    ("docs/calibration.md", "`monitor --json`", "`monitor --plot`"),
    ("docs/my-pad.md", "`gaitpad calibrate --export-sdl`", "`gaitpad calibrate --export`"),
    ("docs/troubleshooting.md", "`build/gaitpad monitor`", "`build/gaitpad watch`"),
    ("config/README.md", "`left_leg.flight_height`", "`left_leg.lift_height`"),
    ("README.md", "`pose_hash`", "`pose_digest`"),
    ("CONTRIBUTING.md", "`kMaxJoints`", "`kMostJoints`"),
    ("CONTRIBUTING.md", "`tools/realtime.sh`", "`tools/punctual.sh`"),
    ("src/strides/README.md", "`StrideSolver::solve()`", "`StrideSolver::run()`"),
    ("src/session/README.md", "`SimulationConfig`", "`SimulationOptions`"),
    ("src/stick/README.md", "`guide.cpp`", "`guided_calibration.cpp`"),  # a file of another room
]


@pytest.mark.parametrize("page, said, false", SABOTAGES, ids=[false for _, _, false in SABOTAGES])
def test_what_does_not_exist_is_found(judge, page, said, false):
    text = (ROOT / page).read_text()
    assert said in text, f"{page} no longer says {said}"
    assert list(judge.faults_of(ROOT / page, text.replace(said, false)))


WALK_PAGES = [ROOT / "docs" / name for name in ("walk.md", "path.md", "tick.md")]


def test_what_the_pages_on_the_walk_name_is_defined_where_they_say(judge):
    faults = [f for page in WALK_PAGES for f in judge.misplaced_in(page)]
    assert not faults, "\n".join(faults)


@pytest.mark.parametrize("page, said, false", [
    ("path.md", "`src/walk/gait_clock.h`, `src/walk/footholds.h` |", "`src/walk/tick.h` |"),  # only called there
    ("walk.md", "`solve_leg()` in `leg_solve.h`", "`at_moments()`"),  # a test's
    ("path.md", "`src/walk/feet.h`, `src/walk/reach.h`, ", "`src/walk/reach.h`, "),
    ("path.md", "`assign_ticks()`", "`decode()`"),  # another room's
    ("path.md", "`solve_paper()` of `src/animation/ik.cpp`", "`solve_paper()` of `src/walk/paper.h`"),
    ("tick.md", "`plan_rest()` in `rest.h`", "`plan_rest()` in `feet.h`"),
    ("tick.md", "`copy_walk()`", "`kMostWalks`"),
])
def test_what_is_defined_elsewhere_is_found(judge, page, said, false):
    text = (ROOT / "docs" / page).read_text()
    assert said in text, f"{page} no longer says {said}"
    assert list(judge.misplaced_in(ROOT / "docs" / page, text.replace(said, false)))


# What is not run here, and why.
NOT_RUN = {
    r"git clone|sudo |cd |blender |systemctl ": "needs the network, root, a real pad, a login or another program",
    r"bash tools/|cmake |c\+\+ |/usr/bin/python3 ": "builds or tests the repository itself",
    r"build-[a-z]+/": "a build of another kind",
}
WAITS_FOR_A_PAD = ("record", "monitor", "calibrate", "map", "selftest")


def blocks_of(page):
    """The blocks of code without a language."""
    return [text for language, text in re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), flags=re.S | re.M)
            if not language]


def statements_of(block):
    """The commands of a block: a line with those that it continues on, or a here-document."""
    lines, found = block.splitlines(), []
    while lines:
        text = lines.pop(0)
        while text.endswith("\\") and lines:
            text += "\n" + lines.pop(0)
        end = re.search(r"<<'?(\w+)'?", text)
        while end and lines:
            text += "\n" + lines.pop(0)
            if text.endswith("\n" + end.group(1)):
                break
        if text.strip() and not text.lstrip().startswith("#"):
            found.append(text)
    return found


def is_command(statement):
    return re.match(r"(build/gaitpad|echo|cat >|cp|sed|mkdir) ?", statement) is not None


def ended(statement):
    """A statement that ends without a person, and its permitted exit statuses."""
    statement = re.sub(r"[ ]+# .*$", "", statement) if "\n" not in statement else statement
    for option, most in (("--frames", 20), ("--crowd", 20)):  # as the page has it, but soon over
        statement = re.sub(rf"{option} (\d+)", lambda m: f"{option} {min(int(m.group(1)), most)}", statement)
    words = statement.split()
    command = words[1] if words[0] == "build/gaitpad" and len(words) > 1 else ""
    is_live = not any(w.endswith(".hid") and words[i - 1] not in ("--record", "--out") for i, w in enumerate(words))
    if command == "play" and "--no-window" not in words and "--frames" not in words:
        return statement + " --frames 20", (0, 1)  # 1: no pad to record
    if command == "play" and "--no-window" in words and "--seconds" not in words:
        return statement + " --seconds 1", (0,)
    if "--view" in words and "--frames" not in words:
        return statement + " --frames 20", (0,)
    if command in WAITS_FOR_A_PAD and is_live and "--trace" not in words:
        if command in ("map", "selftest"):
            return "timeout --preserve-status -s INT 2 " + statement, (0, 1, 130)
        if "--seconds" not in words and command != "calibrate":
            statement += " --seconds 1"
        return re.sub(r"--seconds \d+", "--seconds 1", statement), (0, 1)
    if command == "decode" and "/dev/" in statement:
        return statement, (0, 1)
    return statement, (0, 1) if command in ("doctor", "pads") else (0,)


def needs_again(statement, later):
    """True if a later command of a page names a file or folder that this one writes."""
    written = re.findall(r"(?:--out|--record|--plot|--screenshot|--video|--junit|>) ?(\S+)|mkdir -p (\S+)", statement)
    return any(re.search(rf"{re.escape(''.join(path))}(?![\w-])", text) for path in written for text in later)


@pytest.fixture(scope="module")
def workshop(program, tmp_path_factory):
    """Makes a folder that looks like the repository after tools/run.sh."""
    out = tmp_path_factory.mktemp("out")
    subprocess.run([program, "replay", ROOT / "config/traces/round.hid", "--out", out, "--fps", "60"],
                   check=True, capture_output=True)

    def make():
        folder = tmp_path_factory.mktemp("page")
        for name in ("config", "tools", "docs", "tests"):
            (folder / name).symlink_to(ROOT / name)
        (folder / "build").mkdir()
        (folder / "build/gaitpad").symlink_to(program)
        shutil.copytree(out, folder / "out")
        return folder
    return make


@pytest.fixture(scope="module")
def have_run():
    """The commands that the pages have run so far."""
    return set()


RUN_PAGES = [page for page in PAGES if page.name != "CHANGELOG.md" and any(
    is_command(s) for block in blocks_of(page) for s in statements_of(block))]
CHOSEN_PAGES = [page for page in RUN_PAGES if page.name == "README.md" or slices.is_chosen(page.name, 3)]


@pytest.mark.parametrize("page", CHOSEN_PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_every_command_works(page, workshop, have_run, pytestconfig):
    if pytestconfig.getoption("--quick") and page.name != "README.md":
        pytest.skip("a program with sanitizers runs the commands of the README alone")
    folder = workshop()
    environment = {**os.environ, "SDL_VIDEODRIVER": "offscreen"}
    environment.pop("GAITPAD_CONFIG", None)
    statements = [s for block in blocks_of(page) for s in statements_of(block) if is_command(s)]
    for i, statement in enumerate(statements):
        if "--video" in statement and shutil.which("ffmpeg") is None:
            continue
        if statement in have_run and not needs_again(statement, statements[i + 1:]):
            continue
        have_run.add(statement)
        script, statuses = ended(statement)
        done = subprocess.run(["bash", "-c", script], cwd=folder, env=environment, capture_output=True, text=True,
                              check=False, timeout=300, stdin=subprocess.DEVNULL)
        assert done.returncode in statuses, f"{page.name}: {script}: {done.stdout[-1000:]}{done.stderr}"
        # What a pad would have recorded.
        for path in re.findall(r"(?:--record|--out) (out/\S+\.hid)", statement):
            if not (folder / path).exists():
                shutil.copy(ROOT / "config/traces/walk.hid", folder / path)


def test_what_is_not_run_is_known():
    """A line that neither runs here nor is known to need something else is a mistake in a page or in this list."""
    for page in RUN_PAGES:
        for block in blocks_of(page):
            for statement in statements_of(block):
                known = is_command(statement) or any(re.match(start, statement) for start in NOT_RUN)
                assert known or "gaitpad" not in statement, f"{page.name}: {statement}"


def test_every_sentence_of_a_verdict_is_explained():
    """Reasons in src/stick/pad_analysis.cpp; what stands in their places is N or SIDE on the page."""
    source = (ROOT / "src/stick/pad_analysis.cpp").read_text()
    source = source[source.index("// Reasons for which a side"):source.index("// `opening`")]
    source = re.sub(r'"\n\s*"', "", source)
    page = " ".join((ROOT / "docs/calibration.md").read_text().split())
    texts = [t for t in re.findall(r'"((?:[^"\\]|\\.)*)"', source) if len(t.split()) > 3]
    assert len(texts) > 20
    for text in texts:
        for words in re.split(r"\{[^}]*\}", text):
            words = words.strip(" ,(%)")
            assert len(words.split()) < 2 or words in page, f"{text!r}: no {words!r} in docs/calibration.md"


def test_the_page_on_the_paper_tells_of_each_claim_that_robust_mode_fails():
    page = (ROOT / "docs/paper.md").read_text()
    table, end = page[page.index("<!-- claims -->"):].split("<!-- end of claims -->")
    robust = {int(number) for number in re.findall(r"^\| (\d+) .* \| \*\*[^|]+\*\* \|$", table, flags=re.M)}
    told = end[:end.index("`tools/paper_table.py")]
    assert robust == {int(number) for group in re.findall(r"\(([\d, ]+)\)", told) for number in group.split(",")}


@pytest.mark.parametrize("script", ["measured.py", "constants.py"])
def test_a_page_that_a_script_writes_is_what_it_writes(script):
    assert subprocess.run([sys.executable, ROOT / "tools" / script, "--check"]).returncode == 0


def test_a_trial_multiplies_each_number_that_has_a_name(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "tools")
    import constant_trials
    text = "#pragma once\nconstexpr float kA = 1.0f, kB = 2.0f * kA;  // of a leg\nvoid f() {\n  constexpr double kC = 3.0;\n}\n"
    changed, names = constant_trials.variable(text, "x.h")
    assert names == ["kA", "kB", "kC"]
    assert 'kB = static_cast<float>((2.0f * kA) * trial_factor("x.h:kB"))' in changed
    assert '  static const double kC = static_cast<double>((3.0) * trial_factor("x.h:kC"))' in changed


def test_the_page_of_constants_has_what_the_sources_say():
    """A second reading of some declarations, by hand: beside, above, several in one, in a table."""
    page = (ROOT / "docs/constants.md").read_text()
    for row in ("| `kFirstRoll_s` | 0.25 | s | `gait_clock.h` | from the stick to the lift-off |",
                "| `kHeadAhead_s` | 0.30 | s | `gait_clock.h` | as above |",
                "| `kStairRise` | 0.2 | - | `ground.h` | The rise of a usual riser, 17 cm for an adult, and the highest one "
                "that a step can climb; in legs. |",
                "| `kPhaseTries` | 6 | count | `hips.h` | as above |"):
        assert row in page, row
    unitless = subprocess.run([sys.executable, ROOT / "tools/constants.py", "--unitless"], capture_output=True, text=True)
    assert unitless.returncode == 0 and "kHead" not in unitless.stdout

