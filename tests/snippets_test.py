"""Every block of C++ and C on the pages is compiled and run.

A block with main() is a whole program. Another one goes into the program of docs/library.md that holds places such as
`// set-up`: what stands under such a comment is put behind the same comment there. A ```text block after a program is what it
prints. Blocks of the pages in QUOTES show lines of a source that is tested elsewhere.
"""
import re
import subprocess

import pytest

from support.program import ROOT, ROUND, call, has_sanitizers

QUOTES = {"docs/embed.md": "tools/examples/sdl_game.cpp", "docs/control.md": "tests/session/ai_engine_test.cpp"}
FENCED = re.compile(r"^```(cpp|c)\n(.*?)^```\n(?:(?:It prints|prints)\n```text\n(.*?)^```)?", flags=re.S | re.M)
MOST_LINES = {"docs/library.md": (40, 15)}  # of its first programs
PAGES = sorted(page for page in ROOT.glob("docs/*.md") if FENCED.search(page.read_text()))


def blocks_of(page):
    """The blocks of a page as (language, text, what it prints or None)."""
    return [found.groups() for found in FENCED.finditer(page.read_text())]


def is_whole(text):
    return re.search(r"\bmain\(", text) is not None


def places_of(text):
    """The places of a program, or the parts of a block by place."""
    return re.split(r"^ *// (functions|set-up|before a step|after a step|at the end)\n", text, flags=re.M)


FRAME = next(text for _, text, _ in blocks_of(ROOT / "docs/library.md") if len(places_of(text)) > 1)


def completed(text):
    if is_whole(text):
        return text
    before, *parts = places_of(text)
    assert parts and not before.strip(), f"a block without main() begins with one of the frame's places: {text}"
    added = dict(zip(parts[::2], parts[1::2]))
    begin, *frame = places_of(FRAME)
    assert set(added) <= set(frame[::2])
    return begin + "".join(added.get(place, "") + rest for place, rest in zip(frame[::2], frame[1::2]))


SNIPPETS = {f"{page.stem}-{number}": block for page in PAGES if str(page.relative_to(ROOT)) not in QUOTES
            for number, block in enumerate(blocks_of(page), 1)}


@pytest.fixture(scope="module")
def built(program):
    if has_sanitizers(program):
        pytest.skip("the snippets are compiled without sanitizers")
    return program.parent


@pytest.fixture(scope="module")
def motion(program, tmp_path_factory):
    """A motion for programs that take a file."""
    folder = tmp_path_factory.mktemp("motion")
    call(program, "replay", ROUND, "--out", folder)
    return folder / "pose.bvh"


def run(text, language, built, motion, folder):
    source, binary = folder / f"snippet.{language}", folder / "snippet"
    source.write_text(completed(text))
    compiler = {"cpp": ["g++", "-std=c++20", "-Wno-missing-field-initializers"], "c": ["gcc", "-std=c99", "-D_GNU_SOURCE"]}[language]
    libraries = {"cpp": ["-lgaitpad_files", "-lgaitpad_core", "-lfmt", "-ltomlplusplus", "-lpng"], "c": ["-lgaitpad"]}[language]
    call(*compiler[:1], "-Wall", "-Wextra", "-Werror", *compiler[1:], "-ffp-contract=off", "-I", ROOT / "src/include", source, "-o", binary,
         "-L", built, *libraries, f"-Wl,-rpath,{built}")
    return call(binary, motion, timeout=60)


@pytest.mark.parametrize("name", SNIPPETS)
def test_a_snippet_runs(name, built, motion, tmp_path):
    language, text, prints = SNIPPETS[name]
    out = run(text, language, built, motion, tmp_path)
    if prints is not None:
        assert out == prints
    # What a snippet says it does, it does: `condition ? "the claim" : "otherwise"`.
    for claim in re.findall(r'\? "([^"]+)" : "', text):
        assert claim in out


def test_the_first_programs_are_short():
    for page, most in MOST_LINES.items():
        programs = [text for _, text, _ in blocks_of(ROOT / page) if is_whole(text)]
        assert [len(text.splitlines()) <= lines for text, lines in zip(programs, most)] == [True] * len(most)


@pytest.mark.parametrize("page, source", QUOTES.items())
def test_a_quote_is_what_its_source_says(page, source):
    there = " ".join((ROOT / source).read_text().split())
    lines = [line.split("  //")[0].strip() for _, text, _ in blocks_of(ROOT / page) for line in text.splitlines()]
    assert lines and all(" ".join(line.split()) in there for line in lines), lines


@pytest.mark.parametrize("said, false", [
    ("add_section(*ground, shape)", "add_part(*ground, shape)"),  # this function does not exist
    ("std::make_shared<Terrain>()", "std::make_unique<const Terrain>()"),  # the value has another type
    ("SlopeSection{3.0, 0.1}", "SlopeSection{3.0, 9.0}"),  # the value is refused when the program runs
], ids=["a name", "a type", "a value"])
def test_a_false_snippet_is_found(said, false, built, motion, tmp_path):
    language, text, _ = SNIPPETS["my-ground-1"]
    assert said in text
    with pytest.raises((AssertionError, subprocess.TimeoutExpired)):
        run(text.replace(said, false), language, built, motion, tmp_path)
