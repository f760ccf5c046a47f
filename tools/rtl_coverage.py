#!/usr/bin/env python3
"""Coverage of the RTL by module, from the .dat files that Verilator's models wrote into folders.

rtl_coverage.py FOLDER... [--holes]

A line is covered if each point on it was reached, in some instance and some run: the block that it belongs to and,
where it decides something, the arms that have statements on it. An arm is one way out of an if or a case, the
else that is not written included. A bit is covered if it changed. --holes: also what nothing reached.
"""
import argparse
import collections
import pathlib
import sys

FLOOR = 95.0
RTL = pathlib.Path(__file__).resolve().parent.parent / "rtl"


def points(file):
    """(keys, count) of each line `C '<SOH>key<STX>value...' count`."""
    with open(file, encoding="latin-1") as lines:
        for line in lines:
            if line.startswith("C '"):
                text, count = line[3:].rsplit("' ", 1)
                yield dict(item.split("\x02", 1) for item in text.split("\x01") if "\x02" in item), int(count)


def numbers(ranges):
    """Lines of a list such as 31-33,35."""
    for part in filter(None, ranges.split(",")):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


class Module:
    """Counts of the points of a module, over all its instances and runs."""

    def __init__(self):
        self.blocks = collections.Counter()  # (line, number on it, arm or "block", lines of the source)
        self.bits = collections.Counter()

    def add(self, keys, count):
        if keys["page"].startswith("v_toggle"):
            self.bits[keys["o"]] += count
        else:
            self.blocks[int(keys["l"]), int(keys.get("n", 0)), keys.get("o", "block"), keys.get("S", "")] += count

    def covered_lines(self):
        covered = {}
        for (_, _, _, lines), count in self.blocks.items():
            for line in numbers(lines):
                covered[line] = covered.get(line, True) and count > 0
        return covered

    def covered_arms(self):
        return {key[:3]: count > 0 for key, count in self.blocks.items() if key[2] != "block"}

    def covered_bits(self):
        return {bit: count > 0 for bit, count in self.bits.items()}


def read(folders):
    modules = collections.defaultdict(Module)
    files = [file for folder in folders for file in sorted(pathlib.Path(folder).glob("*.dat"))]
    for file in files:
        for keys, count in points(file):
            modules[pathlib.Path(keys["f"]).stem].add(keys, count)
    return modules, len(files)


def share(covered):
    return 100.0 * sum(covered.values()) / len(covered)


def row(name, kinds):
    cells = [f"{len(covered):>6} {share(covered):>6.1f}" if covered else f"{'-':>6} {'-':>6}" for covered in kinds]
    return f"{name:<18} " + " ".join(cells)


def print_holes(lines, arms, bits):
    for what, covered in ("lines", lines), ("arms", arms), ("bits", bits):
        missed = [key if what != "arms" else f"{key[0]} {key[2]}" for key, hit in sorted(covered.items()) if not hit]
        if missed:
            print(f"    {what}: {', '.join(map(str, missed))}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+")
    parser.add_argument("--holes", action="store_true")
    arguments = parser.parse_args()
    modules, runs = read(arguments.folders)
    if not modules:
        sys.exit(f"{' '.join(arguments.folders)}: no coverage in there; `./dev coverage` writes some")
    print(f"{'module':<18} {'lines':>6} {'%':>6} {'arms':>6} {'%':>6} {'bits':>6} {'%':>6}")
    totals = {}, {}, {}
    for name, module in sorted(modules.items()):
        kinds = module.covered_lines(), module.covered_arms(), module.covered_bits()
        for total, covered in zip(totals, kinds):
            total.update({(name, key): hit for key, hit in covered.items()})
        print(row(name, kinds) + (f"  lines below {FLOOR:g}" if kinds[0] and share(kinds[0]) < FLOOR else ""))
        if arguments.holes:
            print_holes(*kinds)
    print(row(f"{len(modules)} modules", totals))
    others = sorted(path.stem for path in RTL.rglob("*.sv") if path.stem not in modules)
    print(f"{runs} runs of the unit; nothing to count, or not in these builds: {', '.join(others)}")


if __name__ == "__main__":
    main()
