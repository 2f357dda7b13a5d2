#!/usr/bin/env python3
"""What the machine programs of shapes and patterns amount to, as a table.

Usage: machine_table.py PICOT FILE...   with a row for each file and built-in machine.
A program is built, run and compared with its pattern; a refusal is shown with its code.
Exit status 1 when a program has findings of its own.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

COLUMNS = ["shape", "machine", "operations", "passes", "rack", "stack", "verdict"]


def row(picot, path, machine, folder):
    out = folder / f"{path.stem}-{machine}.k"
    build = [picot, "build", str(path), "--machine", machine, "-o", str(out)]
    built = subprocess.run(build, capture_output=True, text=True)
    if built.returncode != 0:
        reasons = [line for line in built.stderr.splitlines() if line.startswith("error[")]
        return [*[""] * 4, "refused: " + (reasons[0] if reasons else built.stderr.strip())], True
    check = [picot, "check", str(out), "--against", str(path), "--format", "json"]
    checked = subprocess.run(check, capture_output=True, text=True)
    file = json.loads(checked.stdout)["files"][0]
    run = file["run"]
    found = [f"{item['code']} {item['message']}" for item in file["diagnostics"] if item["severity"] != "note"]
    cells = [run["operations"], run["passes"], run["widest_rack"], run["largest_stack"]]
    return [*cells, "; ".join(found) or "same loops"], not found


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    picot, paths = sys.argv[1], [pathlib.Path(name) for name in sys.argv[2:]]
    sound = True
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS))
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            for machine in ["swg091n2", "kniterate"]:
                cells, fine = row(picot, path, machine, pathlib.Path(folder))
                sound &= fine
                print("| " + " | ".join(str(cell) for cell in [path.stem, machine, *cells]) + " |", flush=True)
    sys.exit(0 if sound else 1)


if __name__ == "__main__":
    main()
