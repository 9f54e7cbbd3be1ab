#!/usr/bin/python3
"""The pages hold together: lengths, links, names of files, and the measured page is the script's."""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/*.md"), ROOT / "config" / "README.md",
                *ROOT.glob("src/*/README.md"), *ROOT.glob("drivers/README.md")])
NAMED = re.compile(r"`((?:src|drivers|tools|tests|config|docs)/[A-Za-z0-9_./*]+)`")
PLACEHOLDERS = {"tests/data/pads/VVVV_PPPP.hid"}


def text_of(page):
    """Without its blocks of code."""
    return re.sub(r"^```.*?^```", "", page.read_text(), flags=re.S | re.M)


def test_the_readme_is_short():
    assert len((ROOT / "README.md").read_text().splitlines()) <= 200


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


def test_the_measured_page_is_what_the_script_writes():
    assert subprocess.run([sys.executable, ROOT / "tools" / "measured.py", "--check"]).returncode == 0


if __name__ == "__main__":
    for name, test in list(globals().items()):
        if name.startswith("test_"):
            test()
