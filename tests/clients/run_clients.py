#!/usr/bin/env python3
"""Opens what Firn writes in the programs that people use, each check a process of its own:

    run_clients.py --firn build/firn [--folder F] [--usd-python P] [CHECK...]

files     runs the two small scenes of this folder and exports them in every way; the others need its files
readers   meshio, OpenVDB and plain text: every format of points, meshes and volumes, and where the L lies in each
paraview  the series of frames, exported files and the macro, in pvbatch on a display of Xvfb
blender   the add-on, Blender's own importers, volumes and a picture by Cycles, in blender -b
usd       the points of tools/usd/firn_to_usd.py, by the rules of usdchecker

Without a CHECK all of them run, and a table tells the results. A check whose program is missing is skipped (exit code 77
where it is the only one), unless --require names it. Pictures are in the folder.
"""

import argparse
import os
import pathlib
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77
CHECKS = ("files", "readers", "paraview", "blender", "usd")
SYSTEM_PYTHON = "/usr/bin/python3" if os.access("/usr/bin/python3", os.X_OK) else sys.executable  # has Debian's packages


class Missing(Exception):
    """A program that is not installed."""


class Display:
    """An X server without a screen. Without -noreset it would restart as each client leaves, and refuse the next one."""

    def __enter__(self):
        if shutil.which("Xvfb") is None:
            raise Missing("Xvfb")
        ours, theirs = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(theirs), "-noreset", "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
            pass_fds=[theirs], stderr=subprocess.DEVNULL)  # fmt: skip
        os.close(theirs)
        with os.fdopen(ours) as stream:
            number = stream.readline().strip()
        if not number:
            raise RuntimeError("Xvfb does not start")
        return {**system_environment(), "DISPLAY": f":{number}", "LIBGL_ALWAYS_SOFTWARE": "1"}

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()


def system_environment():
    """Debian's ParaView and Blender look for their Python along PATH, and a version manager's has none of their modules."""
    return {**os.environ, "PATH": "/usr/bin" + os.pathsep + os.environ.get("PATH", "")}


def program(name):
    if shutil.which(name) is None:
        raise Missing(name)
    return name


def has_modules(python, *names):
    if shutil.which(python) is None:
        return False
    return subprocess.run([python, "-c", "import " + ", ".join(names)], capture_output=True).returncode == 0


def call(command, **more):
    """Runs a command; returns its exit code."""
    print("$", " ".join(map(str, command)), flush=True)
    return subprocess.run([str(word) for word in command], **more).returncode


def exports(folder):
    """Every way out of Firn that the checks look at: arguments of firn behind the verb and the run's folder."""
    run = folder / "l_shape"
    ways = []
    for client in ("blender", "houdini", "paraview"):
        out = folder / client
        ways.append(("export", run, "--for", client, "--format", "ply", "-o", out))
        ways.append(("export", run, "--for", client, "--format", "vdb", "-o", out))
        for kind in ("obj", "ply", "vdb"):
            ways.append(("surface", run, "--for", client, "--format", kind, "-o", out / "surface"))
    ways.append(("export", run, "--for", "paraview", "--format", "vtp", "-o", folder / "paraview"))
    ways.append(("export", run, "--format", "csv", "-o", folder / "plain"))
    ways.append(("export", folder / "tap", "--for", "blender", "--format", "ply"))
    return ways


def make_files(options):
    folder = options.folder
    for scene in ("l_shape", "tap"):
        command = [options.firn, "run", HERE / f"{scene}.toml", "-o", folder / scene, "--force"]
        if code := call(command, stdout=subprocess.DEVNULL):
            return code
    for way in exports(folder):
        if code := call([options.firn, *way, "--force"], stdout=subprocess.DEVNULL):
            return code
    return 0


def check_readers(options):
    if not has_modules(SYSTEM_PYTHON, "meshio", "pyopenvdb", "h5py"):
        raise Missing("python3-meshio, python3-openvdb or python3-h5py")
    return call([SYSTEM_PYTHON, HERE / "plain_readers.py", options.folder])


def check_paraview(options):
    pvbatch = program("pvbatch")
    picture = options.folder / "paraview.png"
    with Display() as environment:
        return call([pvbatch, HERE / "paraview_series.py", options.folder, picture], env=environment)


def check_blender(options):
    blender = program("blender")
    arguments = [options.folder, options.folder / "blender.png", options.firn]
    return call([blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python", HERE / "blender_client.py", "--", *arguments],
                env={**system_environment(), "BLENDER_USER_SCRIPTS": str(options.folder / "blender_scripts")})


def check_usd(options):
    python = options.usd_python or SYSTEM_PYTHON
    if not has_modules(python, "pxr", "numpy"):
        raise Missing(f"usd-core for {python}")
    target = options.folder / "l_shape.usdc"
    environment = {**os.environ, "FIRN_PYTHON": str(python)}
    command = [options.firn, "export", options.folder / "l_shape", "--for", "houdini", "--format", "usd", "-o", target, "--force"]
    if code := call(command, env=environment, stdout=subprocess.DEVNULL):
        return code
    plys = sorted((options.folder / "houdini").glob("particles.*.ply"))
    return call([python, HERE / "usd_points.py", target, *plys])


def run_check(name, options):
    """Returns (exit code, what to say)."""
    runners = {"files": make_files, "readers": check_readers, "paraview": check_paraview, "blender": check_blender, "usd": check_usd}
    try:
        code = runners[name](options)
        return code, "passed" if code == 0 else f"FAILED ({code})"
    except Missing as missing:
        needed = name in options.require
        return (1 if needed else SKIPPED), f"{'FAILED' if needed else 'skipped'}: {missing} is not installed"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checks", nargs="*", metavar="CHECK", help=", ".join(CHECKS))
    parser.add_argument("--firn", type=pathlib.Path, default=HERE.parents[1] / "build" / "firn", help="the program")
    parser.add_argument("--folder", type=pathlib.Path, default=HERE.parents[1] / "build" / "clients", help="for files and pictures")
    parser.add_argument("--usd-python", help="a Python that has usd-core")
    parser.add_argument("--require", default=os.environ.get("FIRN_REQUIRE_CLIENTS", ""), metavar="'CHECK ...'",
                        help="checks whose program must be there; also by FIRN_REQUIRE_CLIENTS")
    options = parser.parse_args()
    if unknown := set(options.checks) - set(CHECKS):
        parser.error(f"no check is called {', '.join(sorted(unknown))}; there are {', '.join(CHECKS)}")
    options.require = options.require.split()
    options.firn, options.folder = options.firn.resolve(), options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    results = []
    for name in options.checks or CHECKS:
        start = time.monotonic()
        code, text = run_check(name, options)
        results.append((name, code, text, time.monotonic() - start))
    for name, _, text, seconds in results:
        print(f"{name:10} {seconds:6.1f} s  {text}")
    codes = {code for _, code, _, _ in results}
    sys.exit(SKIPPED if codes == {SKIPPED} else 1 if codes - {0, SKIPPED} else 0)


if __name__ == "__main__":
    main()
