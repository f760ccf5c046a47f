"""Runs the Python of docs/trace-format.md as it stands there, and compares what it reads with what the program reads.

usage: check_document.py DOCUMENT DUMP_PROGRAM
Exit code 77: numpy or zstandard is missing, nothing was checked.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

try:
    import numpy as np
    import zstandard  # noqa: F401  (the document's code needs it)
except ImportError as missing:
    print(f"skipped: {missing}; install python3-numpy and python3-zstandard")
    sys.exit(77)


def check(what, condition):
    print(("ok      " if condition else "FAILED  ") + what)
    if not condition:
        sys.exit(1)


def compare(trace, folder, functions):
    def dumped(name, kind):
        return np.fromfile(os.path.join(folder, name), kind)

    rays = dumped("rays.bin", "<u4").reshape(-1, 8)
    check(f"{len(rays)} rays, bit for bit", np.array_equal(trace.rays().view("<u4"), rays))
    hits = dumped("hits.bin", [("t", "<f4"), ("u", "<f4"), ("v", "<f4"), ("primitive", "<u4")])
    for name, values in trace.hits().items():
        check(f"hits.{name}", np.array_equal(values.view("<u4"), hits[name].copy().view("<u4")))

    step = [("ref", "<u4"), ("dropped", "u1"), ("lanes", "u1"), ("detail", "<u2")]
    designs = [one for one in trace.manifest["designs"] if one["stored"]]
    check("three designs", len(designs) == 3)
    for design in designs:
        name = design["design"]
        read, wanted = trace.steps(name), dumped(f"steps-{name}.bin", step)
        for field in ("ref", "dropped", "lanes", "detail"):
            check(f"{len(wanted)} steps.{name}.{field}", np.array_equal(read[field], wanted[field]))
        check(f"steps.{name} of each ray", np.array_equal(read["first"], dumped(f"first-{name}.bin", "<u8")))
        counted = (design["node_visits"] + design["triangle_tests"]) / len(rays)
        check(f"{counted:.3f} intersections a ray", functions["intersections_per_ray"](trace, name) == counted)

    one = trace.column("rays", "tmin", block=1)
    check("one block alone", 0 < len(one) < len(rays))
    words = trace.column("image", "words")
    check("the image's size", 4 * len(words) == trace.manifest["image"]["size_bytes"])


def compare_masks(trace, folder, name, compressed):
    image = trace.manifest["image"]
    masks = trace.masks()
    children = np.concatenate([part[:, 96:112] for part in trace.nodes()]).copy().view("<u4")
    masks[children == 0xFFFFFFFF] = 0
    wanted = np.fromfile(os.path.join(folder, f"masks-{name}.bin"), "<u8")
    check(f"{len(wanted)} words of the masks of {name}", np.array_equal(masks.ravel(), wanted))
    check(f"{name} carries {image['mask_bits']} bits a lane", (image["mask_bits"] < 64) == compressed)


def main(document, dump_program):
    with open(document, encoding="utf-8") as file:
        snippets = re.findall(r"```python\n(.*?)```", file.read(), re.S)
    check("the document has one Python snippet", len(snippets) == 1)
    functions = {}
    exec(compile(snippets[0], document, "exec"), functions)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([dump_program, folder], check=True)
        path = os.path.join(folder, "trace.ctut")
        compare(functions["Trace"](path), folder, functions)
        compare_masks(functions["Trace"](path), folder, "trace", False)
        compare_masks(functions["Trace"](os.path.join(folder, "compressed.ctut")), folder, "compressed", True)
        stripped = functions["Trace"](os.path.join(folder, "stripped.ctut"))
        check("nodes without masks", len(stripped.nodes()[1]) > 0)
        compare_masks(stripped, folder, "stripped", True)
        if shutil.which("zstd"):
            with open(path, "rb") as file:
                check("zstd -t", subprocess.run(["zstd", "-tq"], stdin=file, check=False).returncode == 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
