"""Commands that need no kernel run outside the guest: the same program replays and decodes recordings on the host.
Floating point is emulated in the guest, so a replay takes seconds there and hundredths of a second here.

In the guest:      ask([PROGRAM, "replay", "/results/walk.hid", "--json"]) is as subprocess.run() on the host
On the host:       outside.py RESULTS answers until it or its parent ends; RESULTS is the guest's /results

A question is a file N.ask in RESULTS/.outside, the answer N.answer. Both are renamed into place, so they are whole.
"""
import csv
import io
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

COMMANDS = ("replay", "decode")  # commands that open no device
GUEST = pathlib.Path("/results")
LOOK_S = 0.02


def put(path, content):
    path.with_suffix(".part").write_text(json.dumps(content))
    path.with_suffix(".part").rename(path)


def ask(command, columns=(), seconds=60):
    """Runs the command outside. With `columns` of frames.csv the replay writes its files, and the output is that
    table."""
    question = GUEST / ".outside" / f"{time.monotonic_ns()}.ask"
    answer = question.with_suffix(".answer")
    put(question, {"command": [str(word) for word in command], "columns": list(columns), "seconds": seconds})
    end = time.monotonic() + seconds + 30
    while not answer.exists():
        if time.monotonic() > end:
            raise TimeoutError(f"the host did not answer within {seconds + 30} s: {command}")
        time.sleep(LOOK_S)
    done = subprocess.CompletedProcess(command, **json.loads(answer.read_text()))
    answer.unlink()
    return done


def table(path, columns):
    with open(path, newline="") as file:
        rows = [[row[name] for name in columns] for row in csv.DictReader(file)]
    text = io.StringIO()
    csv.writer(text).writerows([columns, *rows])
    return text.getvalue()


def answer(results, command, columns, seconds):
    assert command[1] in COMMANDS, command
    command = [str(results / word.removeprefix("/results/")) if word.startswith("/results/") else word for word in command]
    with tempfile.TemporaryDirectory() as folder:
        if columns:
            command += ["--out", folder]
        try:
            done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=seconds, check=False)
        except (OSError, subprocess.TimeoutExpired) as error:
            return {"returncode": -1, "stdout": "", "stderr": str(error)}
        output = table(f"{folder}/frames.csv", columns) if columns and done.returncode == 0 else done.stdout
    return {"returncode": done.returncode, "stdout": output, "stderr": done.stderr}


def main(results):
    folder = results / ".outside"
    folder.mkdir(parents=True, exist_ok=True)
    parent = os.getppid()
    while os.getppid() == parent:
        for name in os.listdir(folder):
            if name.endswith(".ask"):
                question = folder / name
                content = json.loads(question.read_text())
                question.unlink()
                put(question.with_suffix(".answer"), answer(results, **content))
        time.sleep(LOOK_S)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]).resolve())
