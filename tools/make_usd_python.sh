#!/usr/bin/env bash
# make_usd_python.sh FOLDER: a Python environment with OpenUSD (usd-core, from PyPI, 30 MB), for the tests of
# tools/usd/firn_to_usd.py. Does nothing if it is there. numpy is Debian's.
set -euo pipefail
folder=${1:?name the folder}
version=26.11
python=/usr/bin/python3
[ -x "$python" ] || python=python3

has_it() { "$folder/bin/python" -c "import numpy, pxr.Usd; assert pxr.Usd.GetVersion() == (0, ${version/./, })" 2>/dev/null; }

has_it && exit 0
rm -rf "$folder"
"$python" -m venv --system-site-packages "$folder"
"$folder/bin/python" -m pip install --quiet --retries 5 --timeout 60 "usd-core==$version"
has_it
