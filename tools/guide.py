#!/usr/bin/env python3
"""Makes the tables and the plot of docs/guide.md: runs the sweeps of docs/sweeps that it rests on, and reads their rows.

    tools/guide.py PROGRAM FOLDER        PROGRAM: ctusim; FOLDER: where the sweeps' folders lie, and are gone on with
"""
import csv
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "guide.md"
PLOT = ROOT / "docs" / "plots" / "guide-designs.svg"
DESIGNS = ["none", "mask-lut", "projection", "dedup", "comparators"]


def run_sweep(program, folder, name):
    """Rows of a sweep, as dictionaries by column."""
    target = folder / name
    subprocess.run([program, "sweep", "run", f"docs/sweeps/{name}.toml", "-o", str(target)], check=True, cwd=ROOT)
    with open(target / "results.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    bad = [row for row in rows if row["status"] != "done"]
    if bad:
        sys.exit(f"{target}: {len(bad)} points without a result, {bad[0]['status']}: {bad[0]['message']}")
    return rows


class Rows:
    """Rows by some of their columns; each such place holds one row."""

    def __init__(self, rows, *keys):
        self.keys = keys
        self.at = {}
        for row in rows:
            place = tuple(row[key] for key in keys)
            if place in self.at:
                sys.exit(f"two rows at {place}")
            self.at[place] = row

    def values(self, key):
        index = self.keys.index(key)
        return list(dict.fromkeys(place[index] for place in self.at))

    def number(self, column, *place):
        return float(self.at[tuple(str(part) for part in place)][column])


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def best(values, texts):
    """The text of the least value in bold."""
    least = min(values)
    return [f"**{text}**" if value == least else text for value, text in zip(values, texts)]


def cycles_by_design(designs, bit_table, r):
    rows = []
    for scene in designs.values("scene"):
        values = [designs.number("cycles_per_ray", scene, r, design) for design in DESIGNS]
        if bit_table:
            values.append(bit_table.number("cycles_per_ray", scene, "bit-table"))
        rows.append([scene] + best(values, [f"{value:.2f}" for value in values]))
    return table(["scene"] + DESIGNS + (["bit-table, 256 entries"] if bit_table else []), rows)


def energy_by_design(designs, r):
    rows = []
    for scene in designs.values("scene"):
        values = [designs.number("energy_per_ray_pj", scene, r, design) for design in DESIGNS]
        rows.append([scene] + best(values, [f"{value / 1000:.2f}" for value in values]))
    return table(["scene"] + DESIGNS, rows)


def bits_by_design(designs, bit_table):
    scene = designs.values("scene")[0]

    def row(name, of, *place):
        table_bits = of.number("mask_test.on_chip_bits", *place) if of.at[place].get("mask_test.on_chip_bits") else 0
        return [name, f"{table_bits / 8192:.1f}", f"{of.number('on_chip_bits', *place) / 8192:.1f}"]

    rows = [row(f"{design}, R = {r}" if design != "none" else design, designs, scene, r, design)
            for r in ("4", "6") for design in DESIGNS if not (design == "none" and r == "6")]
    rows.append(row("bit-table, R = 4, 256 entries", bit_table, scene, "bit-table"))
    return table(["design", "its tables, KiB", "whole unit, KiB"], rows)


def resolutions(designs):
    rows = []
    for scene in designs.values("scene"):
        work = [designs.number("intersections_per_ray", scene, "4", "none"),
                designs.number("intersections_per_ray", scene, "4", "projection"),
                designs.number("intersections_per_ray", scene, "6", "projection")]
        size = [designs.number("image_bytes", scene, r, "none") / 1e6 for r in "46"]
        cycles = [designs.number("cycles_per_ray", scene, "4", "none")] + [
            designs.number("cycles_per_ray", scene, r, "projection") for r in "46"]
        rows.append([scene] + [f"{value:.2f}" for value in work] + [f"{value:.1f}" for value in size] +
                    best(cycles, [f"{value:.2f}" for value in cycles]))
    return table(["scene", "tests/ray, none", "R = 4", "R = 6", "image with masks, MB, R = 4", "R = 6",
                  "cycles/ray, none", "R = 4", "R = 6"], rows)


def banks(rows):
    kinds = [("mask-lut", "3", "mask-lut"), ("projection", "3", "projection, three tables"),
             ("projection", "1", "projection, one table for all axes"), ("dedup", "3", "dedup")]
    counts, lines = rows.values("config.mask_test.banks"), []
    for design, tables, label in kinds:
        for ports in rows.values("config.mask_test.ports"):
            line = [f"{label}, {ports} port" + ("s" if ports != "1" else "")]
            for count in counts:
                worst = max(rows.number("cycles_per_ray", scene, design, tables, ports, count) /
                            rows.number("cycles_per_ray", scene, design, tables, "2", counts[-1])
                            for scene in rows.values("scene"))
                line.append(f"{100 * (worst - 1):+.2f} %")
            lines.append(line)
    return table(["tables"] + [f"{count} banks" if count != "1" else "1 bank" for count in counts], lines)


def draw(designs, bit_table, folder):
    """Cycles of a ray against bits on chip, over those without culling; by gnuplot."""
    data, plots = [], []
    for scene in designs.values("scene"):
        base = designs.number("cycles_per_ray", scene, "4", "none")
        points = [(designs.number("on_chip_bits", scene, r, d) / 8192, designs.number("cycles_per_ray", scene, r, d))
                  for r in "46" for d in DESIGNS[1:]]
        points.append((bit_table.number("on_chip_bits", scene, "bit-table") / 8192,
                       bit_table.number("cycles_per_ray", scene, "bit-table")))
        data.append("\n".join(f"{kib:.2f} {cycles / base:.4f}" for kib, cycles in sorted(points)))
        plots.append(f"'{folder}/guide.dat' index {len(plots)} title '{scene}' with points pt {len(plots) + 4} ps 0.8")
    (folder / "guide.dat").write_text("\n\n\n".join(data) + "\n")
    script = f"""set terminal svg size 760,460 font 'sans,12' background 'white'
set output '{PLOT}'
set logscale x
set xrange [150:1600]
set xtics (150, 200, 300, 500, 700, 1000, 1500)
set xlabel 'memory and registers of the unit, KiB'
set ylabel 'cycles per ray, over those without culling'
set key outside right
set grid
plot 1 notitle lc rgb 'gray', {', '.join(plots)}
"""
    subprocess.run(["gnuplot"], input=script, text=True, check=True)


def put(name, text):
    page = PAGE.read_text()
    begin, end = f"<!-- begin: {name} -->\n", f"<!-- end: {name} -->"
    head, rest = page.split(begin)
    PAGE.write_text(f"{head}{begin}\n{text}\n{end}{rest.split(end, 1)[1]}")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    designs = Rows(run_sweep(program, folder, "designs"), "scene", "r", "design")
    bit_table = Rows(run_sweep(program, folder, "bit-table"), "scene", "design")
    bank_rows = Rows(run_sweep(program, folder, "banks"), "scene", "design", "config.mask_test.projection_tables",
                     "config.mask_test.ports", "config.mask_test.banks")
    put("designs-4", cycles_by_design(designs, bit_table, "4"))
    put("designs-6", cycles_by_design(designs, None, "6"))
    put("energy", energy_by_design(designs, "4"))
    put("bits", bits_by_design(designs, bit_table))
    put("resolutions", resolutions(designs))
    put("banks", banks(bank_rows))
    draw(designs, bit_table, folder)


main()
