#!/usr/bin/python3
"""Writes docs/constants.md: every named constant of the rooms that make a walk, with its value, unit and reason.

  constants.py             writes the page
  constants.py --check     writes nothing; exit status 1 if the page is not what this script writes
  constants.py --unitless  lists the constants that say no unit, neither by their name nor by their comment

The reason is the comment beside a constant, else the one above it, else one of its function that names it, else its
function's. Constants that only count elements or bytes of the
program (sizeof, templates' arguments) are left out.
"""
import argparse
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "constants.md"
ROOMS = {"walk": "The walk", "strides": "Strides that stand", "motion": "From a motion to a stride",
         "animation": "Inverse kinematics and ground"}
HEAD = """\
# Constants of the walk

`tools/constants.py` writes this page from the sources; do not edit it by hand. The unit is the end of the name, *rad* of a
value in degrees, or *count* of whole numbers; where there is a dash, the reason says what the number is. A constant of one
function is written where it is used, so a name may occur twice in a file. Reasons are the sources' comments; *as above*: one comment tells of several.
Lengths *at the reference leg* grow with the character's legs, times with their fourth root. The time constants of the filters
of a tick have no names: `filters_of()` in `tables.cpp` lists them.

*x 2, / 2*: the value was doubled and halved in trials (`tools/constant_trials.py`), and these numbers of the 148 lines of `core_hash`
changed: four walks of 28 s with the built-in motion (level, level in paper mode, over sections, over asked ground) and a
crowd of 20 s. Constants of one name in one file are changed together. A dash: not tried since the value changed. 0, 0 says
only that these walks do not need it: they hold no capture, no push and no asked step.
"""
TRIALS = ROOT / "tools" / "constant_trials.tsv"
DECLARED = re.compile(r"(?m)^([ \t]*)(?:inline |static )*constexpr (?P<type>[\w:]+(?:<[^;={]*?>)?) (?=k[A-Z])")
NAMES = r"(k[A-Z]\w*)((?:\[[^\]]*\])*)\s*"
UNITS = {"s": "s", "m": "m", "rad": "rad", "deg": "degrees", "m_s": "m/s", "m_s2": "m/s²", "rad_s": "rad/s", "1_s": "1/s",
         "s2": "rad/s²", "per_s": "1/s", "m2": "m²", "hz": "Hz", "Hz": "Hz", "ticks": "ticks", "cycles": "cycles",
         "1_m": "1/m", "min": "1/min", "m_min": "m min", "legs_s": "legs/s", "s_m": "s/m", "m_s3": "m/s³", "rad_s2": "rad/s²", "frames": "frames", "legs": "legs"}
# Words by which a comment says what a number without a unit in its name is. Some names have such a word themselves.
SAID = re.compile(r"\bshares?\b|\bof (a|the|its|their|what|both|all)\b|^of\b|\blegs\b|\bcycles?\b|\bticks?\b|\bbeats?\b|\bsamples?\b|"
                  r"\bknots?\b|\bframes?\b|\bmetres?\b|\bdegrees?\b|\bseconds?\b|\bcosts?\b|\bweights?\b|\bratios?\b|\bfactors?\b|"
                  r"\btimes\b", re.I)
NAMED = re.compile(r"Ratio|Grade|Weight|Share|Tolerance|Gain\b|Factor")


def joined(comment):
    return " ".join(line.strip().removeprefix("//").strip() for line in comment if line.strip()).strip()


def end_of(text, start):
    """The position of the `;` that ends a declaration, outside of braces and comments."""
    depth, at = 0, start
    while at < len(text):
        if text.startswith("//", at):
            at = text.index("\n", at)
        elif text[at] in "({[":
            depth += 1
        elif text[at] in ")}]":
            depth -= 1
        elif text[at] == ";" and depth == 0:
            return at
        at += 1
    raise ValueError("a declaration without an end")


def comment_above(lines, number):
    """The comment that ends on the line above `number`. Declarations between them share it."""
    n = number - 1
    while n >= 0 and re.match(r"\s*(?:inline |static )*constexpr .*;", lines[n]) and "//" not in lines[n]:
        n -= 1
    last = n
    while n >= 0 and lines[n].lstrip().startswith("//"):
        n -= 1
    found = lines[n + 1:last + 1]
    return "" if any("// ---" in line for line in found) else joined(found)


def comment_of_function(lines, number, name):
    """Of the function around line `number`: the comment that has the name, else the function's own."""
    found, block = "", []
    for n in range(number - 1, -1, -1):
        line = lines[n]
        if line.lstrip().startswith("//"):
            block.insert(0, line)
            continue
        if block and re.search(rf"\b{name}\b", joined(block)):
            return joined(block)
        if block and block[0].startswith("//"):
            found = joined(block)
            break
        block = []
        if line.startswith("}"):
            break
    return "" if "---" in found else found


def parts_of(text):
    """A declaration's text, split at the commas outside of braces."""
    depth, begin, parts = 0, 0, []
    for at, sign in enumerate(text):
        depth += (sign in "({[") - (sign in ")}]")
        if sign == "," and depth == 0:
            parts.append(text[begin:at])
            begin = at + 1
    return [*parts, text[begin:]]


def value_text(value):
    value = " ".join(value.split())
    value = re.sub(r"static_cast<\w+>\((\w+)\)", r"\1", value)
    value = re.sub(r"(?<=[\d.])f\b", "", value)
    value = re.sub(r"\b(\d+)\.0\b", r"\1", value)
    value = value.replace("{ ", "{").replace(" }", "}")
    return re.sub(r"\bkDegree(_rad)?\b", "degree", value)


def unit_of(name, value, kind):
    _, _, ending = name.partition("_")
    if ending or "kDegree" in value:
        return UNITS.get(ending, ending) or "rad"
    return "count" if kind in ("int", "std::size_t", "std::int64_t") else ""


def constants_of(path):
    """(line, name, value, unit, reason) of each constant of a file."""
    text = path.read_text()
    lines = text.split("\n")
    for found in DECLARED.finditer(text):
        end = end_of(text, found.end())
        first, last = text.count("\n", 0, found.end()), text.count("\n", 0, end)
        said = [re.search(r"//.*", line)[0] for line in lines[first:last + 1] if "//" in line]
        # A comment beside a declaration may go on below it, further to the right.
        for line in lines[last + 1:]:
            if said and re.match(r"\s{20,}//", line):
                said.append(line)
            else:
                break
        reason = joined(said) or comment_above(lines, first)
        declared = re.sub(r"//[^\n]*", "", text[found.end():end])
        for part in parts_of(declared):
            match = re.match(r"\s*" + NAMES + r"(=)?\s*(.*)", part, re.S)
            if not match or not match[4] or "sizeof" in match[4] or "offsetof" in match[4] or found["type"] == "bool":
                continue
            if not re.search(r"\d", match[4]) or len(match[4]) > 120:
                continue
            own = reason or (comment_of_function(lines, first, match[1]) if found[1] else "")
            yield first + 1, match[1], value_text(match[4]), unit_of(match[1], match[4], found["type"]), own


def trials():
    """What constant_trials.py wrote: by "file:name", the value that was tried and the two counts."""
    rows = (line.split("\t") for line in TRIALS.read_text().splitlines()) if TRIALS.exists() else ()
    return {key: (value, f"{doubled}, {halved}") for key, value, doubled, halved in rows}


def page():
    lines, count, tried = HEAD.splitlines(), 0, trials()
    for room, title in ROOMS.items():
        more = (" x 2, / 2 |", "---|") if room == "walk" else ("", "")
        lines += ["", f"## {title}: `src/{room}`", "", f"| constant | value | unit | where | reason |{more[0]}", f"|---|---|---|---|---|{more[1]}"]
        for path in sorted((ROOT / "src" / room).glob("*.[hc]*")):
            last = None
            for line, name, value, unit, reason in constants_of(path):
                count += 1
                told = "as above" if reason and reason == last else reason or "-"
                last = reason
                then, counts = tried.get(f"{path.name}:{name}", ("", "-"))
                trial = (counts if then == value else "-",) if room == "walk" else ()
                cells = (f"`{name}`", value, unit or "-", f"`{path.name}`", told, *trial)
                lines.append("| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |")
    at = len(HEAD.splitlines())
    lines[at:at] = ["", f"There are {count}."]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true", help="exit status 1 if the page is not what this script writes")
    parser.add_argument("--unitless", action="store_true", help="list the constants that say no unit")
    options = parser.parse_args()
    if options.unitless:
        for room in ROOMS:
            for path in sorted((ROOT / "src" / room).glob("*.[hc]*")):
                for line, name, value, unit, reason in constants_of(path):
                    if not unit and not SAID.search(reason) and not NAMED.search(name):
                        print(f"{path.relative_to(ROOT)}:{line}: {name} = {value}")
        return 0
    if options.check:
        if not PAGE.exists() or PAGE.read_text() != page():
            print("docs/constants.md is not what the sources say; run tools/constants.py", file=sys.stderr)
            return 1
        return 0
    PAGE.write_text(page())
    return 0


if __name__ == "__main__":
    sys.exit(main())
