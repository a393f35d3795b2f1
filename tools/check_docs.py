#!/usr/bin/env python3
"""Checks that the project's pages agree with the tree; prints file:line: finding, exits with 1 if any.

    tools/check_docs.py              the repository this file lies in
    tools/check_docs.py --self-test  that each rule finds what it must

- Relative links and images lead to a file, and #fragments to one of its headings.
- A code block whose info string names a file, as in ```toml scenes/first_2d.toml, holds that file's text.
- Backticked paths (`state/grid.h`, `tools/check_docs.py`) and tests (`core.Svd.Reconstructs`) exist.
- The headings of docs/algorithm.md are the verbs of the step; the module table of docs/architecture.md is the one that
  check_layers.py enforces.
- docs/bad-input.md has its rows in order, each with a test.
"""

import argparse
import pathlib
import re
import sys
import tempfile

import check_layers

LINK = re.compile(r"!?\[[^\]]*\]\(([^)\s]+)(?:\s+\"[^\"]*\")?\)")
CODE_SPAN = re.compile(r"`([^`]+)`")
FENCE = re.compile(r"^\s*(```+|~~~+)\s*(.*)$")
HEADING = re.compile(r"^(#+)\s+(.*?)\s*#*$")
TREE_FOLDERS = ("src", "tests", "tools", "docs", "scenes", "cmake", "bench")
PATH = re.compile(r"^[\w.-]+(?:/[\w.-]+)+$")
TEST_NAME = re.compile(r"^([a-z_]+)\.([A-Z]\w*)\.(\w+)$")
TEST_MACRO = re.compile(r"\b(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)")
BAD_INPUT_ROWS = 50
README_BLOCKS = ["scenes/first_2d.toml", "scenes/first_3d.toml"]


def anchor(heading):
    """The #fragment that GitHub gives a heading."""
    text = LINK.sub(lambda m: m[0][m[0].index("[") + 1 : m[0].index("]")], heading)
    text = re.sub(r"[^\w\- ]", "", text.replace("`", "").lower())
    return text.replace(" ", "-")


class Page:
    """A Markdown file, with its code blocks taken apart from its prose."""

    def __init__(self, path):
        self.path = path
        self.prose, self.blocks, self.headings = [], [], []  # (line, text), (line, info, text), (level, text)
        fence, start, info, body = None, 0, "", []
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            match = FENCE.match(line)
            if fence is None and match:
                fence, start, info, body = match[1], number, match[2], []
            elif fence is not None and line.strip().startswith(fence):
                self.blocks.append((start, info, "\n".join(body) + "\n"))
                fence = None
            elif fence is not None:
                body.append(line)
            else:
                self.prose.append((number, line))
                if heading := HEADING.match(line):
                    self.headings.append((len(heading[1]), heading[2]))

    def anchors(self):
        found = set()
        for _, text in self.headings:
            name, count = anchor(text), 0
            while (name if count == 0 else f"{name}-{count}") in found:
                count += 1
            found.add(name if count == 0 else f"{name}-{count}")
        return found


class Checker:
    def __init__(self, root):
        self.root = pathlib.Path(root)
        paths = sorted(self.root.glob("*.md")) + sorted((self.root / "docs").rglob("*.md"))
        self.pages = {path: Page(path) for path in paths}
        self.findings = []

    def report(self, path, line, text):
        self.findings.append(f"{path.relative_to(self.root)}:{line}: {text}")

    def run(self):
        tests = self.test_names()
        for page in self.pages.values():
            self.check_links(page)
            self.check_blocks(page)
            self.check_names(page, tests)
        self.check_readme_blocks()
        self.check_verbs()
        self.check_module_table()
        self.check_bad_input()
        return self.findings

    def check_links(self, page):
        for number, line in page.prose:
            for target in LINK.findall(CODE_SPAN.sub("", line)):
                if re.match(r"[a-z]+:", target):
                    continue
                name, _, fragment = target.partition("#")
                path = (page.path.parent / name).resolve() if name else page.path.resolve()
                if not path.exists():
                    self.report(page.path, number, f"link to {target}: no such file")
                elif fragment and path.suffix == ".md":
                    if fragment not in Page(path).anchors():
                        self.report(page.path, number, f"link to {target}: no such heading")

    def check_blocks(self, page):
        for number, info, text in page.blocks:
            words = info.split()
            if len(words) < 2:
                continue
            file = self.root / words[1]
            if not file.is_file():
                self.report(page.path, number, f"block of {words[1]}: no such file")
            elif file.read_text() != text:
                self.report(page.path, number, f"block differs from {words[1]}")

    def test_names(self):
        names = set()
        for path in (self.root / "tests").rglob("*.cc"):
            module = path.relative_to(self.root / "tests").parts[0]
            names |= {(module, suite, case) for suite, case in TEST_MACRO.findall(path.read_text())}
        return names

    def check_names(self, page, tests):
        for number, line in page.prose:
            for span in CODE_SPAN.findall(line):
                if match := TEST_NAME.match(span):
                    if match.groups() not in tests:
                        self.report(page.path, number, f"no test {span}")
                elif PATH.match(span):
                    first = span.split("/")[0]
                    if first in TREE_FOLDERS and not (self.root / span).exists():
                        self.report(page.path, number, f"no file {span}")
                    if first in check_layers.ALLOWED and "." in span and not (self.root / "src/firn" / span).exists():
                        self.report(page.path, number, f"no file src/firn/{span}")

    def check_readme_blocks(self):
        readme = self.pages.get(self.root / "README.md")
        shown = {info.split()[1] for _, info, _ in readme.blocks if len(info.split()) > 1} if readme else set()
        for name in README_BLOCKS:
            if name not in shown:
                self.report(self.root / "README.md", 1, f"does not show {name}")

    def check_verbs(self):
        header = self.root / "src/firn/integrators/world.h"
        match = re.search(r"kVerbNames\s*=\s*\{([^}]*)\}", header.read_text()) if header.is_file() else None
        verbs = re.findall(r'"(\w+)"', match[1]) if match else []
        path = self.root / "docs/algorithm.md"
        headings = [text.strip("`") for _, text in self.pages[path].headings] if path in self.pages else []
        if not verbs or [h for h in headings if h in verbs] != verbs:
            self.report(path, 1, f"needs one heading per verb of {header.name}, in order: {', '.join(verbs)}")

    def check_module_table(self):
        """Rows `| 3 | name | purpose | a, b |` against the table of check_layers.py; "all above" for no limit."""
        path = self.root / "docs/architecture.md"
        table = {}
        for number, line in self.pages[path].prose if path in self.pages else []:
            if match := re.match(r"\|\s*\d+\s*\|\s*`?(\w+)`?\s*\|.*\|\s*([^|]*?)\s*\|\s*$", line):
                listed = match[2].replace("`", "")
                table[match[1]] = (number, None if listed == "all above" else re.findall(r"\w+", listed))
        if list(table) != check_layers.ORDER:
            self.report(path, 1, f"the modules must be {', '.join(check_layers.ORDER)}; found {', '.join(table)}")
        for module, (number, listed) in table.items():
            if listed != check_layers.ALLOWED.get(module):
                self.report(path, number, f"{module} may include {check_layers.ALLOWED.get(module)}, not {listed}")

    def check_bad_input(self):
        """Rows `| 1 | input | what Firn does | exit code | message | tests |`, whose tests check_names() looks up."""
        path = self.root / "docs/bad-input.md"
        rows = []
        for number, line in self.pages[path].prose if path in self.pages else []:
            if match := re.match(r"\|\s*(\d+)\s*\|", line):
                rows.append(int(match[1]))
                tests = [span for span in CODE_SPAN.findall(line.rstrip(" |").rpartition("|")[2]) if TEST_NAME.match(span)]
                if not tests:
                    self.report(path, number, f"row {match[1]} has no test")
        if rows != list(range(1, BAD_INPUT_ROWS + 1)):
            self.report(path, 1, f"the rows must be 1 to {BAD_INPUT_ROWS}; found {', '.join(map(str, rows)) or 'none'}")


def module_table():
    rows = []
    for number, (module, allowed) in enumerate(check_layers.ALLOWED.items(), 1):
        listed = "all above" if allowed is None else ", ".join(allowed)
        rows.append(f"| {number} | {module} | purpose | {listed} |\n")
    return "".join(rows)


def bad_input_rows(numbers, test="`core.Suite.Case`"):
    return "".join(f"| {n} | input | refuses | 2 | `a | b` | {test} |\n" for n in numbers)


SCENE = "end_time = 1\n"
GOOD_TREE = {
    "README.md": "# Good\n[a](docs/a.md#two-words) `core.Suite.Case` `core/x.h` `tools/t.py`\n"
    + "".join(f"```toml {name}\n{SCENE}```\n" for name in README_BLOCKS)
    + "```\n[not](a-link.md)\n```\n",
    "docs/a.md": "## Two words\n[web](https://example.org) [up](../README.md)\n",
    "docs/algorithm.md": "# Step\n## sort\n## scatter\n",
    "docs/architecture.md": module_table(),
    "docs/bad-input.md": bad_input_rows(range(1, BAD_INPUT_ROWS + 1)),
    "src/firn/core/x.h": "#pragma once\n",
    "src/firn/integrators/world.h": 'kVerbNames = {"sort", "scatter"};\n',
    "tests/core/test_x.cc": "TEST(Suite, Case) {}\n",
    "tools/t.py": "",
    **{name: SCENE for name in README_BLOCKS},
}
BAD_FILES = [
    ("docs/b.md", "[gone](missing.md)\n", "no such file"),
    ("docs/b.md", "![gone](missing.png)\n", "no such file"),
    ("docs/b.md", "[gone](a.md#three-words)\n", "no such heading"),
    ("docs/b.md", "`core.Suite.Gone`\n", "no test"),
    ("docs/b.md", "`core/gone.h`\n", "no file"),
    ("docs/b.md", "`tools/gone.py`\n", "no file"),
    ("docs/b.md", "```toml scenes/first_2d.toml\nend_time = 2\n```\n", "block differs"),
    ("README.md", "# Bare\n", "does not show"),
    ("docs/algorithm.md", "## scatter\n## sort\n", "heading per verb"),
    ("docs/bad-input.md", bad_input_rows(range(1, BAD_INPUT_ROWS)), "rows must be"),
    ("docs/bad-input.md", bad_input_rows(range(1, BAD_INPUT_ROWS + 1), "none"), "has no test"),
    ("docs/bad-input.md", bad_input_rows(range(1, BAD_INPUT_ROWS + 1), "`core.Suite.Gone`"), "no test"),
    ("docs/architecture.md", module_table().replace("| 3 | materials | purpose | core |", ""), "modules must be"),
    ("docs/architecture.md", module_table().replace("| purpose | core |", "| purpose | io |", 1), "may include"),
]


def findings_in(files):
    with tempfile.TemporaryDirectory() as root:
        check_layers.write_tree(root, files)
        return Checker(root).run()


def self_test():
    failures = [f"clean tree: {finding}" for finding in findings_in(GOOD_TREE)]
    for name, text, wanted in BAD_FILES:
        findings = findings_in({**GOOD_TREE, name: text})
        if not any(wanted in finding for finding in findings):
            failures.append(f'{name} {text!r}: expected "{wanted}", got {findings}')
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--root", default=pathlib.Path(__file__).resolve().parent.parent)
    parser.add_argument("--self-test", action="store_true")
    options = parser.parse_args()
    findings = self_test() if options.self_test else Checker(options.root).run()
    print("\n".join(findings) if findings else "check_docs: no findings")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
