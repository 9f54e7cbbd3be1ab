#!/usr/bin/python3
"""Puts the claims of `gaitpad figures` into docs/paper.md, between its two marks.

  paper_table.py FOLDER/claims.json [docs/paper.md]
"""
import json
import pathlib
import sys

BEGIN, END = "<!-- claims -->\n", "<!-- end of claims -->\n"


def cell(claim):
    if claim is None:
        return "-"
    value = "none" if claim["value"] is None else f"{claim['value']:.3g}"
    return f"**{value}**" if claim["pass"] is False else value


def table(claims):
    names = list(dict.fromkeys((c["name"], c["section"]) for c in claims))
    lines = ["| claim | bound | paper | robust |", "|---|---|---|---|"]
    for name, _ in names:
        by_mode = {c["mode"]: c for c in claims if c["name"] == name}
        bounds = " / ".join(dict.fromkeys(c["bound"] for c in by_mode.values()))
        lines.append(f"| {name} | {bounds} | {cell(by_mode.get('paper'))} | {cell(by_mode.get('robust'))} |")
    return lines


def reasons(claims):
    lines = ["", "Why, where it fails:", ""]
    for c in claims:
        if c["pass"] is False and c.get("note"):
            lines.append(f"- {c['name']} ({c['mode']}): {c['note']}")
    return lines


def write(claims, page):
    before, rest = page.read_text().split(BEGIN)
    after = rest.split(END)[1]
    page.write_text(before + BEGIN + "\n".join(table(claims) + reasons(claims)) + "\n" + END + after)


def main():
    page = sys.argv[2] if len(sys.argv) > 2 else pathlib.Path(__file__).resolve().parents[1] / "docs" / "paper.md"
    write(json.loads(pathlib.Path(sys.argv[1]).read_text())["claims"], pathlib.Path(page))


if __name__ == "__main__":
    main()
