#!/usr/bin/env python3
"""Writes random tubes as patterns: random_tubes.py FOLDER COUNT.

Widths of 10 to 60, increases and decreases and short rows at random; the same patterns every time.
"""
import pathlib
import random
import sys


def words(stitches):
    """Stitches with equal neighbors counted: 3 sc, inc, 2 sc."""
    runs = []
    for stitch in stitches:
        if runs and runs[-1][0] == stitch:
            runs[-1][1] += 1
        else:
            runs.append([stitch, 1])
    return ", ".join(name if count == 1 and name != "sc" else f"{count} {name}" for name, count in runs)


def shaped(dice, loops):
    """A round over these loops; returns its words and the loops that it makes."""
    stitches, left, quiet = [], loops, 2
    while left > 0:
        choice = dice.random()
        quiet -= 1
        if quiet < 0 and choice < 0.07 and loops < 56:
            stitches.append("inc")
            left, quiet = left - 1, 2
        elif quiet < 0 and choice < 0.14 and left > 3 and loops > 12:
            stitches.append("dec")
            left, quiet = left - 2, 2
        else:
            stitches.append("sc")
            left -= 1
    return words(stitches), left + sum({"sc": 1, "inc": 2, "dec": 1}[stitch] for stitch in stitches)


def tube(dice):
    loops = dice.randint(10, 60)
    lines = [f"ch {loops}, join", f"Rnd 1: {loops} sc ({loops})"]
    for number in range(2, dice.randint(5, 9)):
        kind = dice.random()
        if kind < 0.35:
            text = f"{loops} sc"
        elif kind < 0.7:
            text, loops = shaped(dice, loops)
        else:
            ahead = dice.randint(loops // 2, loops - 2)
            back = dice.randint(2, max(2, min(ahead - 2, loops // 2)))
            text = f"{ahead} sc, <- {back} sc, -> {back + loops - ahead} sc"
        lines.append(f"Rnd {number}: {text} ({loops})")
    return "\n".join(lines) + "\n"


def main():
    folder, count = pathlib.Path(sys.argv[1]), int(sys.argv[2])
    for index in range(count):
        text = tube(random.Random(1000 + index))
        (folder / f"tube{index}.txt").write_text(f"title: tube {index}\nterms: us\n\n{text}")


if __name__ == "__main__":
    main()
