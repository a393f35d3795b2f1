#!/usr/bin/env python3
"""Runs the fuzz targets of build-fuzz one after another; prints a table; exits with 1 if anything was found.

    tools/fuzz.py --seconds 600             every target
    tools/fuzz.py --seconds 60 mesh_ply     some of them
    tools/fuzz.py --minimise mesh_ply       moves what new inputs reach into tests/fuzz/corpus, as few and small as can be

What a search keeps is under build-fuzz/corpus, and an input that breaks something under build-fuzz/findings.
"""

import argparse
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
SEEDS = ROOT / "tests" / "fuzz" / "corpus"
LIMITS = ["-rss_limit_mb=2048", "-malloc_limit_mb=1024", "-timeout=10"]


def all_targets():
    return sorted(path.stem.removeprefix("fuzz_") for path in (ROOT / "tests" / "fuzz").glob("fuzz_*.cc")
                  if path.stem != "fuzz_target")


def size_of(folder):
    files = [path for path in folder.iterdir() if path.is_file()]
    return len(files), sum(path.stat().st_size for path in files)


def search(build, target, seconds):
    """The row of the table and whether something was found."""
    corpus, findings = build / "corpus" / target, build / "findings"
    corpus.mkdir(parents=True, exist_ok=True)
    findings.mkdir(exist_ok=True)
    dictionary = ROOT / "tests" / "fuzz" / "dictionaries" / f"{target}.dict"
    options = [f"-dict={dictionary}"] if dictionary.exists() else []
    command = [str(build / "tests" / "fuzz" / f"fuzz_{target}"), *LIMITS, *options, f"-max_total_time={seconds}",
               f"-artifact_prefix={findings}/{target}-", "-print_final_stats=1", str(corpus), str(SEEDS / target)]
    with open(build / f"{target}.log", "w", encoding="utf-8", errors="replace") as log:
        code = subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False).returncode
    text = (build / f"{target}.log").read_text(encoding="utf-8", errors="replace")
    if code != 0:
        lines = [line for line in text.splitlines() if re.search(r"finding:|ERROR|SUMMARY|Test unit written", line)]
        print(f"{target}: FOUND something ({build / (target + '.log')})")
        for line in lines:
            print(f"  {line}")
        return None
    runs = re.findall(r"number_of_executed_units: (\d+)", text)
    coverage = re.findall(r"cov: (\d+) ft: (\d+)", text)
    took = re.findall(r"Done \d+ runs in (\d+) second", text)
    return (target, int(runs[-1]), int(coverage[-1][0]), int(coverage[-1][1]), int(took[-1]), *size_of(corpus))


def minimise(build, target):
    corpus = build / "corpus" / target
    # Without counters: one input for each edge of the code, not for each number of times it is passed.
    command = [str(build / "tests" / "fuzz" / f"fuzz_{target}"), *LIMITS, "-merge=1", "-use_counters=0",
               str(SEEDS / target), str(corpus)]
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    files, size = size_of(SEEDS / target)
    print(f"{target}: {files} files, {size} bytes")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", metavar="TARGET", help=", ".join(all_targets()))
    parser.add_argument("--seconds", type=int, default=600, help="for each target; 600")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build-fuzz")
    parser.add_argument("--minimise", action="store_true", help="no search: keep in the repository what earlier ones found")
    arguments = parser.parse_args()
    unknown = set(arguments.targets) - set(all_targets())
    if unknown:
        parser.error(f"unknown target {', '.join(sorted(unknown))}; there are {', '.join(all_targets())}")
    targets = arguments.targets or all_targets()
    if arguments.minimise:
        for target in targets:
            minimise(arguments.build, target)
        return 0
    found = False
    print("| target | executions | edges | features | seconds | inputs kept | bytes |\n|---|---|---|---|---|---|---|")
    for target in targets:
        row = search(arguments.build, target, arguments.seconds)
        found = found or row is None
        if row:
            print("| " + " | ".join(str(cell) for cell in row) + " |", flush=True)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
