#!/usr/bin/env python3
"""Gates of the unit's stages, synthesised one setting after the other, as the table that results read
(sim/energy/gate_area.csv).

    tools/gate_area.py build/release/ctusim > sim/energy/gate_area.csv

Stages of arithmetic are there by the parameters that they depend on. Stages of control, which grow with contexts, miss
registers and stack entries, are fitted: gate equivalents = the sum of coefficients times products of these. Rows of
`check` are whole units, for the test and the page that say how far the table is off. About half an hour on one idle
core with an empty cache, minutes with a full one.
"""
import csv
import itertools
import json
import subprocess
import sys


def area(program, stages, sets, options=()):
    """Stage -> (gate equivalents, flip-flops), or None where the RTL does not have it."""
    command = [program, "area", "--json", "--threads", "1", *options]
    if stages:
        command += ["--stages", ",".join(stages)]
    for key, value in sets.items():
        command += ["--set", f"{key}={value}"]
    print(" ".join(command[1:]), file=sys.stderr, flush=True)
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    report = json.loads(done.stdout)
    found = {s["stage"]: (s["gate_equivalents"], s["flip_flops"]) for s in report["stages"]}
    found["all"] = (report["total"]["gate_equivalents"], report["total"]["flip_flops"])
    return found


def exact(program, write):
    def row(stage, key, sets, options=()):
        write(stage, key, *area(program, [stage], sets, options)[stage])

    for bits, inner in itertools.product([32, 16], [1, 0]):
        design = "projection" if inner else "none"
        row("box_test", f"inner={inner} bits={bits}", {"mask_test.design": design}, ["--box-bits", str(bits)])
    for stage in ["child_sort", "hit_update", "result_queue", "triangle_test"]:
        row(stage, "", {})
    for interval in [3, 6]:
        row("ray_queue", f"interval={interval}", {"ray_setup.interval": interval})
    row("cell_locate", "keys r=4 units=1", {})
    row("cell_locate", "comparators r=4 units=1", {"mask_test.design": "comparators"})
    row("mask_test", "design=comparators r=4 entries=0", {"mask_test.design": "comparators"})
    for design, banks in [("projection", 4), ("projection", 2), ("projection", 1), ("mask-lut", 4), ("mask-lut", 1),
                          ("dedup", 4)]:
        row("mask_test", f"design={design} r=4 r_ray=4 entries=0 rows=all banks={banks} ports=1",
            {"mask_test.design": design, "mask_test.banks": banks})
    row("sphere_test", "", {}, ["--spheres"])
    row("primitive_cull", "units=1", {}, ["--primitive-boxes"])


def solve(rows, values):
    """Least squares by the normal equations, with the pivots in order of size."""
    n = len(rows[0])
    a = [[sum(r[i] * r[j] for r in rows) for j in range(n)] + [sum(r[i] * v for r, v in zip(rows, values))]
         for i in range(n)]
    for c in range(n):
        pivot = max(range(c, n), key=lambda i: abs(a[i][c]))
        a[c], a[pivot] = a[pivot], a[c]
        for i in range(n):
            if i != c:
                factor = a[i][c] / a[c][c]
                a[i] = [x - factor * y for x, y in zip(a[i], a[c])]
    return [a[i][n] / a[i][i] for i in range(n)]


def fitted(program, write):
    def fit(stage, key, settings, terms, options=()):
        """`settings`: lists of (sets, values of the terms' variables)."""
        points = [area(program, [stage], sets, options)[stage][0] for sets, _ in settings]
        rows = [[term(*values) for term in terms] for _, values in settings]
        solution = solve(rows, points)
        worst = max(abs(sum(c * x for c, x in zip(solution, row)) / point - 1) for row, point in zip(rows, points))
        write("fit " + stage, key, *solution, f"worst={worst:.3f}")

    # Both fetches have the same caches in the source of the unit: one parameter says it for both. A bit a set says
    # whether anything was installed there.
    fetch = [(8, 4, 4, 64), (8, 16, 4, 64), (32, 4, 4, 64), (32, 16, 4, 64), (32, 8, 4, 64), (32, 16, 1, 64),
             (32, 16, 4, 16), (32, 16, 2, 16)]
    for stage in ["node_fetch", "leaf_fetch"]:
        settings = []
        for c, m, w, kib in fetch:
            sets = {"unit.contexts": c}
            for cache in ["node_cache", "leaf_cache"]:
                sets |= {f"{cache}.mshrs": m, f"{cache}.ways": w, f"{cache}.bytes": 1024 * kib}
            settings.append((sets, (c, m, w, 8 * kib / w)))
        fit(stage, "ports=1", settings,
            [lambda c, m, w, s: 1, lambda c, m, w, s: c, lambda c, m, w, s: m, lambda c, m, w, s: c * m,
             lambda c, m, w, s: w, lambda c, m, w, s: s])
    fit("scheduler", "", [({"unit.contexts": c}, (c,)) for c in [8, 32]], [lambda c: 1, lambda c: c])
    fit("traversal_stack", "", [({"unit.contexts": c, "stack.entries": e, "stack.spill_batch": min(8, e)}, (c, e))
                                for c, e in [(8, 16), (32, 16), (32, 8)]],
        [lambda c, e: 1, lambda c, e: c, lambda c, e: e])


def whole(program, write):
    for sets in [{}, {"mask_test.design": "none"}]:
        found = area(program, [], sets)
        write("check", " ".join(f"{k}={v}" for k, v in sets.items()), *found["all"], found["link"][0],
              found["link"][1])


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    out = csv.writer(sys.stdout, lineterminator="\n")
    out.writerow(["stage", "parameters", "gate_equivalents or coefficients", "flip_flops"])

    def write(stage, key, *values):
        out.writerow([stage, key, *(v if isinstance(v, str) else f"{v:.6g}" if isinstance(v, float) else v for v in values)])
        sys.stdout.flush()

    whole(sys.argv[1], write)
    exact(sys.argv[1], write)
    fitted(sys.argv[1], write)


if __name__ == "__main__":
    main()
