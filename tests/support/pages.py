"""Finds names in backticks on pages and checks that the sources or the program's help have them."""
import functools
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE_ROOTS = ("src", "drivers", "tools", "tests", "config")
LOOSE = ("CMakeLists.txt", "CMakePresets.json", ".clang-format", ".clang-tidy")
BINARY = {".png", ".gif", ".bvh", ".hid", ".pyc"}
SOURCE_FILE = re.compile(r"(?<![\w./~$-])[\w.*-][\w./*-]*\.(?:cpp|h|c|py|sh|toml|md|gd|txt|json|hid|png)(?!\w)")
ELSEWHERE = re.compile(r"(?<!\w)(?:~|\$\w+)?/[\w./*$~-]+")  # paths on the reader's machine: ~/.config, /dev, /etc
PLACEHOLDER = re.compile(r"[A-Z]+|vvvv|pppp")  # placeholders such as NAME, FILE

# Comments by language; quoted text is kept, because pages also name keys and messages.
QUOTED = r'"(?:\\.|[^"\\\n])*"|' + r"'(?:\\.|[^'\\\n])*'"
COMMENTS = {
    **dict.fromkeys((".cpp", ".h", ".c"), re.compile(QUOTED + r"|(//[^\n]*|/\*.*?\*/)", re.S)),
    **dict.fromkeys((".py", ".gd"), re.compile(QUOTED + r'|("""(?:.|\n)*?"""|\#[^\n]*)')),
}


def spans_of(text):
    """The texts in backticks outside of blocks of code, as (text, its line or table row)."""
    text = re.sub(r"^```.*?^```", "", text, flags=re.S | re.M)
    for block in re.split(r"\n(?=[|\-*]|\d+\. |\n)|\n\n", text):
        for span in re.findall(r"`([^`]+)`", block):
            yield " ".join(span.split()), " ".join(block.split())


class Sources:
    """The repository's files, read once, without their comments."""

    def __init__(self):
        paths = [p for root in SOURCE_ROOTS for p in (ROOT / root).rglob("*") if p.is_file()]
        paths += [ROOT / name for name in LOOSE]
        self.paths = {p.relative_to(ROOT).as_posix() for p in (*paths, *ROOT.glob("*.md"), *ROOT.glob("docs/*"))}
        self.text = {}
        for path in paths:
            if path.suffix in BINARY or path.suffix == ".md" or path.name in ("docs_test.py", "pages.py"):
                continue
            text = path.read_text(errors="ignore")
            if path.suffix not in COMMENTS:
                text = re.sub(r"^\s*#[^\n]*", "", text, flags=re.M)
            if comment := COMMENTS.get(path.suffix):
                text = comment.sub(lambda m: m.group(0) if m.group(1) is None else " ", text)
            self.text[path.relative_to(ROOT).as_posix()] = text
        everything = self.everything = "\n".join(self.text.values())
        self.words = set(re.findall(r"[A-Za-z_]\w*", everything)) | {
            word for path in self.paths for word in re.findall(r"[A-Za-z_]\w*", path)} | {
            f"test_{p.name}" for p in (ROOT / "tests").iterdir() if p.is_dir()}  # the test programs
        self.functions = set(re.findall(r"([A-Za-z_]\w*)\s*(?:<[^<>;(){}]*>)?\(", everything))

    @functools.lru_cache(maxsize=None)
    def files_named(self, name, room=None):
        """The files that a page may mean by that name: a path from the root, from the room, or the end of a path."""
        pattern = re.compile(re.escape(name.rstrip("/")).replace(r"\*", "[^/]*"))
        if room and "/" not in name and name.endswith((".cpp", ".h")):
            return [p for p in self.paths if p.startswith(room) and pattern.fullmatch(p.rsplit("/", 1)[1])]
        return [p for p in self.paths if re.search(rf"(?:^|/){pattern.pattern}(?:/|$)", p)]

    @functools.lru_cache(maxsize=None)
    def of_src(self):
        return [text for path, text in self.text.items() if path.startswith("src/")]

    @functools.lru_cache(maxsize=None)
    def members(self, owner):
        """The words in the braces of that class or namespace, in all files."""
        words = set()
        for opened in re.finditer(rf"\b(?:class|struct|enum|namespace)\s+{owner}\b[^;{{()]*{{", self.everything):
            depth, end = 1, opened.end()
            for brace in re.finditer(r"[{}]", self.everything[end:]):
                depth += 1 if brace.group() == "{" else -1
                if depth == 0:
                    words |= set(re.findall(r"[A-Za-z_]\w*", self.everything[end:end + brace.start()]))
                    break
        return words

    def has_member(self, owner, name):
        return name in self.members(owner) or re.search(rf"\b{owner}::{name}\b", self.everything) is not None


class Help:
    """The program's commands and their options."""

    def __init__(self, program):
        def told(*arguments):
            return subprocess.run([program, *arguments, "--help"], capture_output=True, text=True, check=True).stdout
        subcommands = told().split("\nSubcommands:\n")[-1]
        self.text = {c: told(c) for c in re.findall(r"^  ([a-z]+)(?=  |$)", subcommands, flags=re.M)}
        assert len(self.text) > 12
        self.options = {c: set(re.findall(r"(?<![\w-])-{1,2}[a-z][\w-]*", text)) | {"--help"}
                        for c, text in self.text.items()}


class Judge:
    """Reports the parts of a span that do not exist."""

    def __init__(self, program, foreign):
        self.sources, self.help = Sources(), Help(program)
        self.foreign = foreign
        self.all_options = set().union(*self.help.options.values()) | {
            option for path, text in self.sources.text.items() if path.startswith(("tools/", "tests/", "src/doctor", "CMake"))
            for option in re.findall(r"(?<![\w-])-{1,2}[a-zA-Z][\w-]*", text)}

    @staticmethod
    def is_foreign(span, page, foreign):
        """True if one of the expressions matches the span, or the page and the span."""
        told = f"{page.relative_to(ROOT)}: {span}"
        return any(re.fullmatch(name, span) or re.fullmatch(name, told) for name in foreign)

    def faults_of(self, page, text=None):
        room = page.parent.relative_to(ROOT).as_posix() + "/"
        room = room if room.startswith(("src/", "drivers/")) else None
        for span, block in spans_of(page.read_text() if text is None else text):
            if not self.is_foreign(span, page, self.foreign):
                for fault in self.faults_of_span(span, block, room):
                    yield f"{page.relative_to(ROOT)}: `{span}`: {fault}"

    def faults_of_span(self, span, block, room):
        yield from self.faults_of_command(span)
        rest = ELSEWHERE.sub(" ", span)
        for name in SOURCE_FILE.findall(rest):
            is_example = name.startswith("out/") or any(PLACEHOLDER.fullmatch(w) for w in re.findall(r"\w+", name))
            if not is_example and not self.is_made(name) and not self.sources.files_named(name, room):
                yield f"there is no file {name}" + (f" in {room}" if room else "")
                rest = rest.replace(name, " ")
        for owner, name in re.findall(r"\b(\w+)::(\w+)", rest):
            if not self.sources.has_member(owner, name):
                yield f"{owner} has no {name}"
        for name in re.findall(r"(?<![\w:.])(?:\w+\.)?([A-Za-z_]\w*)\(", rest):
            if name not in self.sources.functions:
                yield f"no function {name}"
        for name in re.findall(r"(?<![\w:.])([A-Za-z_]\w*)\(\)", rest):
            yield from self.fault_of_place(name, block, room)
        rest = re.sub(r"(?<![\w-])--?[a-z][\w-]*", " ", rest)
        for word, is_start in re.findall(r"([A-Za-z_]\w*)(\*?)", rest):
            if len(word) > 1 and not self.is_called(word, is_start) and not PLACEHOLDER.fullmatch(word):
                yield f"nothing is called {word}"

    def is_called(self, word, is_start):
        words = self.sources.words
        return word in words or bool(is_start) and any(w.startswith(word) for w in words)

    def fault_of_place(self, function, block, room):
        """The fault of a table row that names sources and functions, if the functions are elsewhere; None if there is
        none."""
        if not block.startswith("|"):
            return
        files = [p for span in re.findall(r"`([^`]+)`", block) for p in self.sources.files_named(span, room)
                 if re.search(r"\.(cpp|h)$|^(drivers|src)/\w+$", span)]
        texts = [self.sources.text[p] for p in files if p in self.sources.text]
        if texts and not any(re.search(rf"\b{function}\s*(?:<[^<>;(){{}}]*>)?\(", text) for text in texts):
            yield f"no {function}() in the files of its row"

    def misplaced_in(self, page, text=None):
        """Functions and constants without an owner that no source of src defines, and functions that the file does not
        define that the page names for them: `name()` in `file`, `name()` of `file`, or the files of the row."""
        text = page.read_text() if text is None else text
        for span, block in spans_of(text):
            for name in re.findall(r"(?<![\w:.])([A-Za-z_]\w*)\(\)", span):
                own = re.findall(rf"`{name}\(\)` (?:in|of) `([^`]+)`", block)
                row = re.findall(r"`([^`]+\.(?:cpp|h))`", block) if block.startswith("|") else []
                yield from self.fault_of_definition(name, own or row)
            for name in re.findall(r"\bk[A-Z]\w+", span):
                if not any(re.search(rf"\b{name}\b(?:\[[^\]]*\])* *[={{]", text) for text in self.sources.of_src()):
                    yield f"no constant {name} in src"

    def fault_of_definition(self, function, files):
        places = [p for name in files for p in self.sources.files_named(name)]
        texts = [self.sources.text[p] for p in places if p in self.sources.text] if files else self.sources.of_src()
        definition = re.compile(rf"^[\w\[](?!.*;$).*\b{function}\(", re.M)
        if not any(definition.search(text) for text in texts):
            yield f"{function}() is not defined in {', '.join(files) or 'src'}"

    def is_made(self, name):
        """True for files that the program writes or reads: its sources contain their names."""
        return "/" not in name and any(
            f'{name}"' in text or f'{pathlib.Path(name).stem}"' in text for p, text in self.sources.text.items()
            if p.startswith(("src/", "tools/", "drivers/")))

    def faults_of_command(self, span):
        words = span.split()
        while words and (words[0] in ("sudo", "bash") or re.match(r"[A-Z_]+=", words[0])):
            words = words[1:]
        if not words:
            return
        is_program = words[0] in ("gaitpad", "build/gaitpad") and len(words) > 1
        command = words[1] if is_program else words[0]
        if is_program and command not in self.help.text and command not in ("help", "COMMAND", "..."):
            if not command.startswith("-"):
                yield f"no command {command}"
        known = self.help.options.get(command, self.all_options)
        if not is_program and command in self.help.text and len(words) == 1:
            return
        for word in words:
            for option in re.findall(r"^--?[a-zA-Z][\w-]*", word):
                if option.split("=")[0] not in known:
                    yield f"no option {option}" + (f" of {command}" if command in self.help.text else "")
