#!/usr/bin/env python3
"""Mutants of the numeric core: which sources each is built of, its mutated files, and whether `ctusim check` finds it.

  mutate.py plan MUTATIONS ROOT            CMake calls, one a mutation, to standard output
  mutate.py lay MUTATIONS ROOT NAME FOLDER write the mutated files under FOLDER
  mutate.py run MUTATIONS BIN [NAME...]    run the mutants built in BIN, all that are there, and one without a mutation,
                                           which must find nothing; a table
"""

import pathlib
import re
import subprocess
import sys
import tomllib

# What is compiled anew when a header is mutated. The oracle, the judge and the generators keep the true headers.
MUTATED_FOLDERS = ("model/intersect", "model/accel", "model/cull", "model/reference")
INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)


class BadMutation(Exception):
    pass


def read(path):
    with open(path, "rb") as file:
        return tomllib.load(file)


def edits_of(mutations, mutation):
    """The fault itself and the edits that it needs, as (file, find, replace)."""
    edits = [mutation] + [mutations["edits"][name] for name in mutation.get("also", [])]
    return [(edit["file"], edit["find"], edit["replace"]) for edit in edits]


def includes(root, file, known):
    """All files of the project that `file` includes, directly or not."""
    if file not in known:
        known[file] = set()
        for name in INCLUDE.findall((root / file).read_text()):
            if (root / name).exists():
                known[file] |= {name} | includes(root, name, known)
    return known[file]


def sources_of(root, files, known):
    """The sources whose objects differ from the true ones."""
    sources = {file for file in files if file.endswith(".cpp")}
    headers = set(files) - sources
    for folder in MUTATED_FOLDERS:
        for path in (root / folder).glob("*.cpp"):
            source = str(path.relative_to(root))
            if headers & includes(root, source, known):
                sources.add(source)
    return sorted(sources)


def plan(mutations, root):
    known = {}
    for mutation in mutations["mutation"]:
        files = sorted({file for file, _, _ in edits_of(mutations, mutation)})
        print(
            f"ctu_mutant({mutation['name']}\n"
            f"  FILES {' '.join(files)}\n"
            f"  SOURCES {' '.join(sources_of(root, files, known))}\n"
            f"  NEEDS {' '.join(mutation.get('needs', []))}\n"
            f"  QUICK {'ON' if mutation.get('quick') else 'OFF'})"
        )


def lay(mutations, root, name, folder):
    mutation = next(m for m in mutations["mutation"] if m["name"] == name)
    texts = {}
    for file, find, replace in edits_of(mutations, mutation):
        text = texts.get(file) or (root / file).read_text()
        places = text.count(find)
        if places != 1:
            raise BadMutation(
                f"mutation {name}: its text is {places} times in {file}, not once:\n  {find}\n"
                "  give it the text that is there now, in tests/mutations/mutations.toml"
            )
        texts[file] = text.replace(find, replace)
    for file, text in texts.items():
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def control_run(folder):
    """Cases that the campaign did without a mutation; it must not find a loss."""
    control = subprocess.run([folder / "unmutated", "20"], capture_output=True, text=True, check=False)
    if control.returncode != 0:
        sys.exit(f"without a mutation a hit is lost too: {control.stdout}{control.stderr}")
    return control.stdout.split()[1]


def run(mutations, folder, names):
    chosen = [m for m in mutations["mutation"] if not names or m["name"] in names]
    missed = run_count = 0
    control = None if names else control_run(folder)
    print(f"{'mutation':<36} {'caught by':<26} {'cases':>9} {'seconds':>8}  what is broken")
    for mutation in chosen:
        program = folder / mutation["name"]
        if not program.exists():
            print(f"{mutation['name']:<36} not built: needs {', '.join(mutation.get('needs', []))}")
            continue
        run_count += 1
        done = subprocess.run([program], capture_output=True, text=True, check=False)
        fields = done.stdout.split() if done.returncode in (0, 1) else []
        if done.returncode != 1 or len(fields) != 3:
            missed += 1
            fields = ["NOT CAUGHT", "", ""] if done.returncode == 0 else [f"ENDED WITH {done.returncode}", "", ""]
            sys.stderr.write(done.stderr)
        print(f"{mutation['name']:<36} {fields[0]:<26} {fields[1]:>9} {fields[2]:>8}  {mutation['breaks']}", flush=True)
    print(f"{run_count} mutants, {missed} not caught" + (f"; no loss without one in {control} cases" if control else ""))
    return 0 if missed == 0 and run_count > 0 else 1


def main(arguments):
    command, mutations = arguments[0], read(arguments[1])
    if command == "plan":
        plan(mutations, pathlib.Path(arguments[2]))
    elif command == "lay":
        lay(mutations, pathlib.Path(arguments[2]), arguments[3], pathlib.Path(arguments[4]))
    elif command == "run":
        return run(mutations, pathlib.Path(arguments[2]), arguments[3:])
    else:
        sys.exit(__doc__)
    return 0


if __name__ == "__main__":
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1:]))
    except BadMutation as error:
        sys.exit(str(error))
