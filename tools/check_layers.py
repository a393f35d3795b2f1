#!/usr/bin/env python3
"""Checks the rules of the source tree that a compiler does not see; prints file:line: finding, exits with 1 if any.

    tools/check_layers.py              the repository this file lies in
    tools/check_layers.py --root DIR   another tree
    tools/check_layers.py --self-test  that each rule finds what it must, on trees made for that
"""

import argparse
import pathlib
import re
import sys
import tempfile

# The modules in dependency order and what each may include besides itself. docs/architecture.md shows the same table;
# check_docs.py compares the two. None: every module above it.
ALLOWED = {
    "core": [],
    "geometry": ["core"],
    "materials": ["core"],
    "state": ["core"],
    "transfer": ["core", "state"],
    "colliders": ["core", "geometry"],
    "integrators": ["core", "geometry", "materials", "state", "transfer", "colliders"],
    "seeding": ["core", "geometry", "state"],
    "measure": ["core", "materials", "state", "colliders"],
    "surface": ["core", "geometry", "state"],
    "io": ["core", "geometry", "state"],
    "scene": None,
    "simulation": None,
    "render": ["core", "geometry", "state", "measure", "surface", "io"],
    "apps": None,
    "reader": ["core", "geometry", "io"],
}
ORDER = list(ALLOWED)

# Libraries that only these modules (and apps) may include: formats, windows and ray tracing stay behind their module.
LIBRARY_OWNERS = {
    "toml++/": ["scene"],
    "hdf5": ["io"],
    "embree": ["render"],
    "openvdb/": ["surface", "reader"],
    "assimp/": ["reader"],
    "png.h": ["io", "render"],
    "stb/": ["render"],
    "muParser": ["core"],
    "CLI/": [],
    "epoxy/": [],
    "GLFW/": [],
    "imgui": [],
}

INTRINSICS_ALLOWED = ["core", "transfer"]
MAX_LINES = 500
UNSPLIT = {"tools/blender/import_firn.py"}  # Blender installs an add-on of one file with one choice
SOURCE_SUFFIXES = {".h", ".cc", ".inc"}
TEXT_SUFFIXES = SOURCE_SUFFIXES | {".py", ".sh", ".md", ".txt", ".cmake", ".toml", ".json", ".yml", ""}
TEXT_FOLDERS = ["src", "tests", "tools", "docs", "cmake", "scenes", "bench", ".ci"]

INCLUDE = re.compile(r'^\s*#\s*include\s*(<([^>]+)>|"([^"]+)")')
USING_NAMESPACE = re.compile(r"^\s*using\s+namespace\b")
INTRINSICS = re.compile(r"\b(_mm\d*_\w+|__m\d+[di]?)\b|#\s*include\s*<(\w*intrin|arm_neon)\.h>")
MACHINE_PATH = re.compile(r"(?<![\w.~$}/-])/(?:home|work|root|Users)/\w")


def allowed_modules(module):
    """What `module` may include, itself with it."""
    others = ALLOWED[module]
    return [module] + (ORDER[: ORDER.index(module)] if others is None else others)


def read_lines(path):
    return path.read_text(encoding="utf-8", errors="replace").splitlines()


def includes_of(lines):
    """(line number, name, quoted) of every include."""
    for number, line in enumerate(lines, 1):
        if match := INCLUDE.match(line):
            yield number, match[2] or match[3], match[3] is not None


class Checker:
    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.source = self.root / "src" / "firn"
        self.findings = []

    def report(self, path, line, text):
        self.findings.append(f"{path.relative_to(self.root)}:{line}: {text}")

    def sources(self):
        return sorted(p for p in self.source.rglob("*") if p.suffix in SOURCE_SUFFIXES)

    def module_of(self, path):
        return path.relative_to(self.source).parts[0]

    def run(self):
        for path in self.sources():
            lines = read_lines(path)
            module = self.module_of(path)
            if module not in ALLOWED:
                self.report(path, 1, f'"{module}" is no module; tools/check_layers.py and docs/architecture.md list them')
                continue
            self.check_includes(path, module, lines)
            self.check_header(path, lines)
            self.check_intrinsics(path, module, lines)
        self.check_cycles()
        self.check_declared_dependencies()
        self.check_texts()
        return self.findings

    def check_includes(self, path, module, lines):
        for number, name, quoted in includes_of(lines):
            if quoted:
                self.report(path, number, f'include "{name}" with angle brackets and its full path: <firn/module/file.h>')
            if name.startswith("firn/"):
                target = name.split("/")[1]
                if target not in allowed_modules(module):
                    self.report(path, number, f"{module} may not include {target} (<{name}>)")
                if not (self.root / "src" / name).is_file():
                    self.report(path, number, f"<{name}> does not exist")
            for prefix, owners in LIBRARY_OWNERS.items():
                if name.startswith(prefix) and module not in owners + ["apps"]:
                    self.report(path, number, f"<{name}> belongs behind {' and '.join(owners + ['apps'])}")

    def check_header(self, path, lines):
        if path.suffix == ".cc":
            return
        for number, line in enumerate(lines, 1):
            if USING_NAMESPACE.match(line):
                self.report(path, number, "a header may not have a using directive")
        if path.suffix == ".inc":
            return
        text = "\n".join(lines)
        if path.name.endswith("-inl.h"):
            guard = re.sub(r"\W", "_", str(path.relative_to(self.root / "src"))).upper() + "_"
            if f"#if defined({guard}) == defined(HWY_TARGET_TOGGLE)" not in text or f"#undef {guard}" not in text:
                self.report(path, 1, f"per-target header without the toggled guard {guard}")
        elif "#pragma once" not in lines:
            self.report(path, 1, "header without #pragma once")

    def check_intrinsics(self, path, module, lines):
        if module in INTRINSICS_ALLOWED:
            return
        for number, line in enumerate(lines, 1):
            if match := INTRINSICS.search(line):
                self.report(path, number, f"raw intrinsic {match[0]}; use Lanes (core/lanes-inl.h)")

    def check_cycles(self):
        graph = {}
        for path in self.sources():
            name = str(path.relative_to(self.root / "src"))
            graph[name] = [n for _, n, _ in includes_of(read_lines(path)) if n.startswith("firn/")]
        state = {}  # 1: on the current path, 2: done

        def visit(name, trail):
            state[name] = 1
            for target in graph.get(name, []):
                # A .cc that names itself for foreach_target is not an include; a header that includes itself is.
                if state.get(target) == 1:
                    cycle = trail[trail.index(target):] + [target] if target in trail else [name, target]
                    self.report(self.root / "src" / name, 1, "include cycle: " + " -> ".join(cycle))
                elif target not in state:
                    visit(target, trail + [target])
            state[name] = 2

        for name in graph:
            if name not in state:
                visit(name, [name])

    def check_declared_dependencies(self):
        """What a module includes must follow from DEPENDS in its CMakeLists.txt, and DEPENDS from the table."""
        declared = {}
        for module in ORDER:
            cmake = self.source / module / "CMakeLists.txt"
            if not cmake.is_file():
                continue
            text = cmake.read_text()
            match = re.search(r"\bDEPENDS\s+([a-z_\s]+)", text)
            declared[module] = (match[1].split() if match else []) + self.linked_modules(text)
            for target in declared[module]:
                if target not in allowed_modules(module):
                    self.report(cmake, 1, f"{module} may not depend on {target}")

        def closure(module):
            found = {module}
            for target in declared.get(module, []):
                if target not in found:
                    found |= closure(target) if ORDER.index(target) < ORDER.index(module) else {target}
            return found

        for module in declared:
            reached = closure(module)
            for path in sorted(p for p in (self.source / module).rglob("*") if p.suffix in SOURCE_SUFFIXES):
                for number, name, _ in includes_of(read_lines(path)):
                    if name.startswith("firn/") and (target := name.split("/")[1]) not in reached and target in ALLOWED:
                        self.report(path, number, f"{module} uses {target} without DEPENDS {target}")

    @staticmethod
    def linked_modules(cmake_text):
        """Modules that programs (which are no firn_module) name as firn_<module>."""
        links = " ".join(re.findall(r"target_link_libraries\(([^)]*)\)", cmake_text))
        return [name for name in re.findall(r"\bfirn_([a-z]+)\b", links) if name in ALLOWED]

    def check_texts(self):
        paths = [p for p in self.root.iterdir() if p.is_file() and p.name != ".git"]  # a file in a linked worktree
        for folder in TEXT_FOLDERS:
            paths += [p for p in (self.root / folder).rglob("*") if p.is_file()]
        for path in sorted(paths):
            if path.suffix not in TEXT_SUFFIXES or "__pycache__" in path.parts:
                continue
            lines = read_lines(path)
            for number, line in enumerate(lines, 1):
                if match := MACHINE_PATH.search(line):
                    self.report(path, number, f"path of one machine: {match[0]}...")
            if path.suffix in SOURCE_SUFFIXES | {".py"} and len(lines) > MAX_LINES and path.relative_to(self.root).as_posix() not in UNSPLIT:
                self.report(path, MAX_LINES + 1, f"{len(lines)} lines; more than {MAX_LINES} call for a split")


GOOD_INL = """#if defined(FIRN_CORE_GOOD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef FIRN_CORE_GOOD_INL_H_
#undef FIRN_CORE_GOOD_INL_H_
#else
#define FIRN_CORE_GOOD_INL_H_
#endif
#endif
"""
GOOD_TREE = {
    "src/firn/core/good.h": "#pragma once\n#include <vector>\n",
    "src/firn/core/good-inl.h": GOOD_INL,
    "src/firn/core/CMakeLists.txt": "firn_module(core SOURCES good.cc)\n",
    "src/firn/state/good.cc": "#include <firn/core/good.h>\nusing namespace std;\n",
    "src/firn/state/CMakeLists.txt": "firn_module(state\n  SOURCES good.cc\n  DEPENDS core)\n",
    "docs/good.md": "Run /usr/bin/env and see https://example.org/home/page or tests/home/x.\n",
}
# One added file each, and the finding that it must give.
BAD_FILES = [
    ("src/firn/core/up.cc", "#include <firn/state/good.h>\n", "core may not include state"),
    ("src/firn/materials/side.cc", "#include <firn/state/x.h>\n", "materials may not include state"),
    ("src/firn/core/quoted.cc", '#include "good.h"\n', "angle brackets"),
    ("src/firn/core/missing.cc", "#include <firn/core/absent.h>\n", "does not exist"),
    ("src/firn/core/loop.h", "#pragma once\n#include <firn/core/loop.h>\n", "include cycle"),
    ("src/firn/core/leaky.h", "#pragma once\nusing namespace std;\n", "using directive"),
    ("src/firn/core/unguarded.h", "#include <vector>\n", "#pragma once"),
    ("src/firn/core/plain-inl.h", "#pragma once\n", "toggled guard"),
    ("src/firn/state/fast.cc", "#include <immintrin.h>\n", "raw intrinsic"),
    ("src/firn/state/fast2.cc", "auto a = _mm256_setzero_ps();\n", "raw intrinsic"),
    ("src/firn/core/long.cc", "//\n" * (MAX_LINES + 1), "call for a split"),
    ("src/firn/core/parse.cc", "#include <toml++/toml.h>\n", "belongs behind"),
    ("src/firn/plugins/a.cc", "\n", "is no module"),
    ("src/firn/geometry/CMakeLists.txt", "firn_module(geometry DEPENDS state)\n", "may not depend on state"),
    ("docs/setup.md", "Open /" + "home/someone/firn.\n", "path of one machine"),
]


def write_tree(root, files):
    for name, text in files.items():
        path = pathlib.Path(root) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def findings_in(files):
    with tempfile.TemporaryDirectory() as root:
        write_tree(root, files)
        return Checker(root).run()


def self_test():
    failures = [f"clean tree: {finding}" for finding in findings_in(GOOD_TREE)]
    cases = [({**GOOD_TREE, name: text}, name, wanted) for name, text, wanted in BAD_FILES]
    two_file_loop = {
        **GOOD_TREE,
        "src/firn/core/a.h": "#pragma once\n#include <firn/core/b.h>\n",
        "src/firn/core/b.h": "#pragma once\n#include <firn/core/a.h>\n",
    }
    cases.append((two_file_loop, "a.h, b.h", "include cycle"))
    undeclared = {**GOOD_TREE, "src/firn/state/CMakeLists.txt": "firn_module(state SOURCES good.cc)\n"}
    cases.append((undeclared, "state/CMakeLists.txt", "without DEPENDS core"))
    for files, name, wanted in cases:
        findings = findings_in(files)
        if not any(wanted in finding for finding in findings):
            failures.append(f'{name}: expected "{wanted}", got {findings}')
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    findings = self_test() if options.self_test else Checker(options.root).run()
    print("\n".join(findings) if findings else "check_layers: no findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
