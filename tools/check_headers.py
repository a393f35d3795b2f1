#!/usr/bin/env python3
"""Checks that every header compiles alone: whoever includes it needs nothing else first, and nothing precompiled.

    tools/check_headers.py --build build [--jobs 2]     needs build/compile_commands.json
    tools/check_headers.py --self-test                  that a header which leans on another is found

Each is compiled with the flags of the build, precompiled headers and all. What these would hide is found in the text: a
name of the standard library must come from a header that is included, by itself or through headers of Firn. Results
are kept in BUILD/check_headers.json by the hash of flags, header and all Firn headers it reaches, so that a second run only looks
at what has changed. Headers of libraries are taken as unchanging: delete the file after upgrading one.
"""

import argparse
import concurrent.futures
import hashlib
import json
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

INCLUDE = re.compile(r"^\s*#\s*include\s*<([^>]+)>", re.MULTILINE)
STANDARD_NAME = re.compile(r"\bstd::(\w+)")
COMMENT = re.compile(r"//.*")
LAUNCHERS = {"ccache", "sccache", "distcc"}
DEFAULT_FLAGS = ["c++", "-std=c++20", "-Wall", "-Wextra", "-Werror"]

# Headers of the standard library, and the names that our headers may take from each.
PROVIDERS = {
    "algorithm": "clamp copy_n equal fill fill_n find_if lower_bound max max_element min ranges sort",
    "array": "array get size_t",
    "atomic": "atomic",
    "bit": "popcount",
    "bitset": "bitset size_t",
    "chrono": "chrono",
    "cmath": "abs asinh atan ceil copysign exp fabs floor ilogb isfinite ldexp log lround pow signbit sin sqrt tan",
    "condition_variable": "condition_variable",
    "cstddef": "byte ptrdiff_t size_t",
    "cstdint": "int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t",
    "cstdio": "FILE size_t",
    "cstdlib": "abs free size_t",
    "cstring": "memcpy size_t",
    "deque": "deque size_t",
    "exception": "exception_ptr",
    "filesystem": "filesystem",
    "functional": "function reference_wrapper",
    "iosfwd": "istream",
    "istream": "istream",
    "limits": "numeric_limits",
    "map": "map size_t",
    "memory": "make_unique shared_ptr unique_ptr size_t",
    "mutex": "mutex unique_lock",
    "new": "align_val_t size_t",
    "numbers": "numbers",
    "optional": "nullopt optional",
    "set": "set size_t",
    "span": "begin end size size_t span",
    "stdexcept": "runtime_error",
    "string": "begin end size size_t string to_string",
    "string_view": "begin end size size_t string_view",
    "thread": "thread",
    "type_traits": "conditional_t integral_constant is_const_v is_enum_v is_integral_v is_invocable_v is_same_v is_trivially_copyable_v remove_const_t",
    "utility": "get move pair size_t",
    "variant": "get get_if variant",
    "vector": "begin end size size_t vector",
}
HEADERS_OF_NAME = {name: {h for h in PROVIDERS if name in PROVIDERS[h].split()} for names in PROVIDERS.values()
                   for name in names.split()}


def compiler_flags(command):
    """Compiler and flags of one entry of compile_commands.json, without its files."""
    words = shlex.split(command)
    while pathlib.Path(words[0]).name in LAUNCHERS:
        words.pop(0)
    flags, skip = [], False
    for word in words:
        if skip:
            skip = False
        elif word in ("-o", "-c", "-MF", "-MT"):
            skip = True
        elif not word.startswith("-M") and not word.endswith((".cc", ".o")):
            flags.append(word)
    return flags


class HeaderCheck:
    def __init__(self, root, commands, cache_file=None):
        self.source = pathlib.Path(root) / "src"
        self.cache_file = cache_file
        self.cache = json.loads(cache_file.read_text()) if cache_file and cache_file.is_file() else {}
        self.flags_of_folder = {}
        self.compiled = 0
        for entry in commands:
            path = pathlib.Path(entry["file"])
            if self.source in path.parents:
                self.flags_of_folder[path.parent] = compiler_flags(entry["command"])
        self.fallback = next(iter(self.flags_of_folder.values()), DEFAULT_FLAGS + [f"-I{self.source}"])

    def headers(self):
        return sorted(str(p.relative_to(self.source)) for p in self.source.rglob("*.h"))

    def reached_text(self, name, seen):
        """The text of a header and of all Firn headers that it includes, each once."""
        if name in seen or not (self.source / name).is_file():
            return ""
        seen.add(name)
        text = (self.source / name).read_text()
        return text + "".join(self.reached_text(n, seen) for n in INCLUDE.findall(text) if n.startswith("firn/"))

    def missing_includes(self, name):
        """Messages for the names of the standard library whose header is not included."""
        included = set(INCLUDE.findall(self.reached_text(name, set())))
        text = COMMENT.sub("", (self.source / name).read_text())
        for used in sorted(set(STANDARD_NAME.findall(text))):
            headers = HEADERS_OF_NAME.get(used)
            if headers is None:
                yield f"std::{used} is not in the table of tools/check_headers.py: add it to the line of its header"
            elif not headers & included:
                yield f"std::{used} needs #include <{'> or <'.join(sorted(headers))}>"

    def compile(self, name):
        """(name, cache key, messages of the compiler if it fails)"""
        flags = self.flags_of_folder.get((self.source / name).parent, self.fallback)
        key = hashlib.sha256("\0".join(flags + [self.reached_text(name, set())]).encode()).hexdigest()
        if self.cache.get(name) == key:
            return name, key, None
        self.compiled += 1
        # Twice, because a guard that fails shows only then.
        text = f"#include <{name}>\n#include <{name}>\n"
        run = subprocess.run(flags + ["-fsyntax-only", "-x", "c++", "-"], input=text, capture_output=True, text=True)
        return name, key, run.stderr or "failed" if run.returncode else None

    def run(self, jobs):
        findings = []
        names = self.headers()
        for name in names:
            findings += [f"src/{name}: {message}" for message in self.missing_includes(name)]
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            for name, key, errors in pool.map(self.compile, names):
                if errors:
                    findings.append(f"src/{name}: does not compile alone\n{errors}")
                else:
                    self.cache[name] = key
        if self.cache_file:
            self.cache_file.write_text(json.dumps(self.cache, indent=0, sort_keys=True))
        return findings, f"{len(names)} headers, {self.compiled} of them compiled"


def self_test():
    files = {
        "good.h": "#pragma once\n#include <vector>\ninline std::vector<int> numbers() { return {1}; }\n",
        "uses_good.h": "#pragma once\n#include <firn/core/good.h>\ninline auto size() { return numbers().size(); }\n",
        "bare.h": "#pragma once\nnamespace std { template <class T> class vector; class odd; }\n"
                  "std::vector<int>* no_include(std::odd*);\n",
        "leans.h": "#pragma once\ninline auto leaning() { return numbers().size(); }\n",
        "unguarded.h": "struct Twice {};\n",
    }
    with tempfile.TemporaryDirectory() as root:
        folder = pathlib.Path(root) / "src/firn/core"
        folder.mkdir(parents=True)
        for name, text in files.items():
            (folder / name).write_text(text)
        cache = pathlib.Path(root) / "cache.json"
        found = [finding.split(":")[0] for finding in HeaderCheck(root, [], cache).run(2)[0]]
        wanted = ["src/firn/core/bare.h", "src/firn/core/bare.h", "src/firn/core/leans.h", "src/firn/core/unguarded.h"]
        if found != wanted:
            return [f"expected findings in {wanted}, got {found}"]
        # What passed is remembered; what it includes counts as part of it.
        if sorted(json.loads(cache.read_text())) != ["firn/core/bare.h", "firn/core/good.h", "firn/core/uses_good.h"]:
            return [f"unexpected cache: {cache.read_text()}"]
        (folder / "good.h").write_text("#pragma once\n")
        found = [finding.split(":")[0] for finding in HeaderCheck(root, [], cache).run(2)[0]]
        if "src/firn/core/uses_good.h" not in found:
            return ["a change in an included header went unnoticed"]
    return []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    if options.self_test:
        findings, counts = self_test(), "self-test"
    else:
        if options.build is None:
            parser.error("--build FOLDER is needed")
        commands = options.build / "compile_commands.json"
        if not commands.is_file():
            parser.error(f"{commands} is missing; configure with -DCMAKE_EXPORT_COMPILE_COMMANDS=ON (the presets do)")
        root = pathlib.Path(__file__).resolve().parent.parent
        check = HeaderCheck(root, json.loads(commands.read_text()), options.build / "check_headers.json")
        findings, counts = check.run(options.jobs)
    print("\n".join(findings) if findings else f"check_headers: {counts}, no findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
