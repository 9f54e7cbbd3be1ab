"""The installed gaitpad: manual pages, completions, files for desktops and udev."""
import pathlib
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET

import pytest

from support.program import ROOT, call

APP = "io.github.gaitpad.gaitpad"


@pytest.fixture(scope="module")
def prefix(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("prefix")
    call("cmake", "--install", program.parent, "--prefix", folder, "--component", "program")
    return folder


@pytest.fixture(scope="module")
def commands(run):
    text = run("--help").stdout.partition("Subcommands:")[2].partition("\n\n")[0]
    return re.findall(r"^  (\w+) ", text, flags=re.M)


@pytest.fixture(scope="module")
def pages(prefix):
    """The text of each manual page; man finds no fault in any."""
    if not shutil.which("man"):
        pytest.skip("man-db is not installed")
    texts = {}
    for page in (prefix / "share/man/man1").iterdir():
        done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "--local-file", page], capture_output=True, text=True, check=False,
                              env={"PATH": "/usr/bin:/bin", "LC_ALL": "C.UTF-8", "MANWIDTH": "200", "MAN_KEEP_FORMATTING": ""})
        assert (done.returncode, done.stderr) == (0, ""), page
        texts[page.name.removesuffix(".1.gz")] = done.stdout.replace("\u2010", "-")
    return texts


def test_the_installed_program_finds_its_configuration(prefix, tmp_path):
    program = prefix / "bin/gaitpad"
    (prefix / "share/gaitpad/styles/only_here.toml").write_text("fatigue = 0.5\n")
    trace = prefix / "share/gaitpad/traces/round.hid"
    text = call(program, "replay", trace, "--style", "only_here", cwd=tmp_path)
    assert "style only_here at the end" in text or "pose hash" in text


def test_rules_desktop_file_and_icon_are_where_they_are_read(prefix):
    assert (prefix / "lib/udev/rules.d/60-gaitpad.rules").read_text() == \
        (ROOT / "config/udev/60-gaitpad.rules").read_text()
    entry = (prefix / f"share/applications/{APP}.desktop").read_text()
    icon = re.search(r"^Icon=(.*)$", entry, flags=re.M)[1]
    ET.parse(prefix / f"share/icons/hicolor/scalable/apps/{icon}.svg")
    info = ET.parse(prefix / f"share/metainfo/{APP}.metainfo.xml").getroot()
    assert info.findtext("id") == APP and info.findtext("launchable") == f"{APP}.desktop"
    version = re.search(r"project\(gaitpad VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
    assert info.find("releases/release").get("version") == version


@pytest.mark.parametrize("tool, file", [(["desktop-file-validate"], f"share/applications/{APP}.desktop"),
                                        (["appstreamcli", "validate", "--no-net"], f"share/metainfo/{APP}.metainfo.xml")])
def test_validators_find_no_fault(prefix, tool, file):
    if not shutil.which(tool[0]):
        pytest.skip(f"{tool[0]} is not installed; tools/package_test.sh runs it")
    call(*tool, prefix / file)


# ---- manual pages ----------------------------------------------------------------------------
def test_each_command_has_a_page(prefix, commands):
    assert "check" in commands and "replay" in commands
    pages = {page.name for page in (prefix / "share/man/man1").iterdir()}
    assert pages == {"gaitpad.1.gz", *(f"gaitpad-{command}.1.gz" for command in commands)}


def test_pages_have_the_texts_of_help(pages, run, commands):
    for command in commands:
        page = " ".join(pages[f"gaitpad-{command}"].split())
        help_text = run(command, "--help").stdout
        description = " ".join(help_text.split("\n\n")[0].partition("Usage:")[0].split())
        assert description.rstrip(".") in page, command  # the same text in NAME and, as a sentence, in DESCRIPTION
        options = help_text.partition("Options:")[2].partition("\n\n")[0]
        for name in re.findall(r"^  (?:-\w,)?(--[\w-]+)", options, flags=re.M):
            assert re.search(re.escape(name) + r"\b", page), f"{command}: {name}"
        for line in help_text.partition("Examples:")[2].splitlines():
            assert " ".join(line.split()) in page, f"{command}: {line}"
        assert ("EXAMPLES" in page) == ("Examples:" in help_text)
    assert "EXAMPLES" in pages["gaitpad-check"]


# ---- completions -----------------------------------------------------------------------------
@pytest.fixture
def complete(prefix, tmp_path):
    """bash's completions after these words, with the installed program first in PATH."""
    (tmp_path / "mine.hid").write_text("")
    (tmp_path / "folder").mkdir()
    script = prefix / "share/bash-completion/completions/gaitpad"

    def offers(*words):
        listed = " ".join(f"'{word}'" for word in ("gaitpad", *words))
        done = call("bash", "--norc", "-c", f"""
            source {script}
            COMP_WORDS=({listed}) COMP_CWORD={len(words)}
            _gaitpad
            printf '%s\\n' "${{COMPREPLY[@]}}" """, cwd=tmp_path,
                    env={"PATH": f"{prefix / 'bin'}:/usr/bin:/bin", "HOME": str(tmp_path)})
        return [line for line in done.splitlines() if line]
    return offers


def test_bash_completes_commands(complete, commands):
    assert set(complete("")) == set(commands)
    assert complete("rep") == ["replay"]


def test_bash_completes_options_of_the_command(complete):
    assert complete("check", "--sh") == ["--shard"]
    assert {"--style", "--out", "--help"} <= set(complete("replay", "--"))
    assert "--shard" not in complete("replay", "--")


@pytest.mark.parametrize("option, folder", [("--style", "styles"), ("--character", "characters"), ("--terrain", "terrain"),
                                            ("--motion", "motions")])
def test_bash_completes_names_of_files_of_the_configuration(complete, option, folder):
    names = {path.stem for path in (ROOT / "config" / folder).glob("*.toml")}
    offered = complete("replay", "mine.hid", option, "")
    assert names <= set(offered)
    one = sorted(names)[0]
    assert one in complete("replay", option, one[:3])
    assert one in complete("replay", option, "=", one[:3]), "bash takes --option=word apart"
    assert all(name.startswith(one[:3]) for name in complete("replay", option, one[:3]))


def test_bash_completes_sets_of_words(complete):
    assert complete("replay", "--pace", "") == ["own", "adult"]
    assert complete("replay", "--ik", "r") == ["robust"]
    assert complete("replay", "--rate", "") == []


def test_bash_completes_files_and_folders(complete):
    assert "mine.hid" in complete("replay", "m")
    assert set(complete("check", "--plot", "")) == {"folder"}
    assert complete("decode", "mine.hid", "m") == [], "one recording is all that decode takes"
    for command in ("replay", "check"):
        assert complete(command, "mine.hid", "m") == ["mine.hid"], "it takes many"


def test_pads_that_are_plugged_are_offered(complete, run):
    """The same nodes are offered as `pads` lists through evdev; on a machine without pads none."""
    import json
    nodes = {pad["path"] for pad in json.loads(run("pads", "--json").stdout)
             if pathlib.Path(pad["path"]).name.startswith("event")}
    offered = {word for word in complete("play", "/dev/input/ev") if re.search(r"/event\d+$", word)}
    assert nodes <= offered


def test_zsh_completes(prefix, tmp_path):
    """The function is called itself; zsh's own two functions that it calls are replaced by ones that print."""
    if not shutil.which("zsh"):
        pytest.skip("zsh is not installed")
    script = next(prefix.glob("share/zsh/*/_gaitpad"))

    def offers(*words):
        return call("zsh", "--no-rcs", "-c", f"""
            _files() {{ print -- files "$@" }}
            _describe() {{ print -l -- "${{(@P)2}}" }}
            words=({" ".join(f"'{word}'" for word in ("gaitpad", *words))}) CURRENT={len(words) + 1}
            source {script}""", env={"PATH": f"{prefix / 'bin'}:/usr/bin:/bin", "HOME": str(tmp_path)}).splitlines()
    assert {line.partition(":")[0] for line in offers("replay", "--style", "lim")} >= {"limp_left"}
    assert any(line.startswith("check:replays recordings") for line in offers("ch"))
    assert "files -/" in offers("check", "--plot", "")


def test_fish_completes(prefix, tmp_path):
    if not shutil.which("fish"):
        pytest.skip("fish is not installed")
    text = call("fish", "--no-config", "-c", f"""
        source {prefix}/share/fish/vendor_completions.d/gaitpad.fish
        complete -C 'gaitpad replay --style lim'""", env={"PATH": f"{prefix / 'bin'}:/usr/bin:/bin", "HOME": str(tmp_path)})
    assert {line.split("\t")[0] for line in text.splitlines()} >= {"limp_left"}
