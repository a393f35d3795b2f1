#!/usr/bin/env python3
"""Checks that materials look alike everywhere: the colours of src/firn/render/look.cc are those of the ParaView macro and
of the Blender add-on. Prints what differs; exits with 1 if anything does.

    tools/check_looks.py              the repository this file lies in
    tools/check_looks.py --self-test  that a difference is found
"""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
NUMBERS = r"\s*([\d.]+)F?,\s*([\d.]+)F?,\s*([\d.]+)F?\s*"
SOURCE = re.compile(r'(?:\w+\("|\.name = ")(\w+)",\s*(?:\.color = )?\{\{' + NUMBERS + r"\}\}")
TABLES = {
    "tools/paraview/firn_points.py": re.compile(r'"(\w+)": \(' + NUMBERS + r"\)"),
    "tools/blender/import_firn.py": re.compile(r'"(\w+)": \(\(' + NUMBERS + r"\)"),
}


def colors(pattern, text):
    return {match[1]: tuple(float(number) for number in match.groups()[1:]) for match in pattern.finditer(text)}


def differences(source, tables):
    """source: text of look.cc; tables: text of each file of TABLES."""
    wanted, found = colors(SOURCE, source), []
    if len(wanted) < 20:
        found.append(f"src/firn/render/look.cc: only {len(wanted)} looks are understood")
    for name, text in tables.items():
        table = colors(TABLES[name], text)
        for look in sorted(set(wanted) | set(table)):
            if wanted.get(look) != table.get(look):
                found.append(f"{name}: {look} is {table.get(look)}, in src/firn/render/look.cc {wanted.get(look)}")
    return found


def main():
    source = (ROOT / "src/firn/render/look.cc").read_text(encoding="utf-8")
    tables = {name: (ROOT / name).read_text(encoding="utf-8") for name in TABLES}
    if sys.argv[1:] == ["--self-test"]:
        changed = source.replace("0.55F, 0.035F, 0.05F", "0.56F, 0.035F, 0.05F", 1)
        if len(differences(changed, tables)) < len(TABLES) or not differences("", tables):
            sys.exit("check_looks: does not find a difference")
        return
    found = differences(source, tables)
    print("\n".join(found) if found else "check_looks: no findings")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
