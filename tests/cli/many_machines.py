#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The recipes of docs/many-machines.md, run as they stand there.

    many_machines.py PROGRAM

GNU parallel renders the shards of a batch; Slurm's script is checked for its syntax and run as an array job would run
it; both must make the bytes of one process. What is not installed is skipped, and counted.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PROGRAM = pathlib.Path(sys.argv[1]).resolve()
PAGE = (ROOT / "docs" / "many-machines.md").read_text()
SLURM = ROOT / "examples" / "slurm" / "render_batch.sh"
VIEWS = 24
skipped = []


def run(folder, command, **variables):
    environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", **variables}
    done = subprocess.run(["bash", "-euo", "pipefail", "-c", command], cwd=folder, env=environment,
                          capture_output=True, text=True, timeout=900)
    if done.returncode != 0:
        sys.exit(f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def make_inputs(folder):
    folder.mkdir()
    views = [{"camera-direction": [1, number / VIEWS, -0.4], "resolution": [96, 72]} for number in range(VIEWS)]
    batch = {"views": views, "outputs": {"output": "{model}_{view}.pfm", "depth": "{view}.npy"}}
    (folder / "views.json").write_text(json.dumps(batch))


def pictures(folder):
    made = {path.name: path.read_bytes() for path in folder.iterdir() if path.suffix in (".pfm", ".npy")}
    if len(made) != 2 * VIEWS:
        sys.exit(f"{folder}: {len(made)} files")
    return made


def recipe(beginning):
    """The line of the page with this beginning."""
    found = [line for line in PAGE.splitlines() if line.startswith(beginning)]
    if len(found) != 1:
        sys.exit(f"docs/many-machines.md: {len(found)} lines begin with '{beginning}'")
    return found[0].replace("engine.glb", "builtin:teapot")


def check(folder, expected):
    if pictures(folder) != expected:
        sys.exit(f"{folder.name}: not the bytes of one process")
    run(folder, "frontmost batch-merge . | grep -q '24 views, 48 files'")


def try_parallel(folder, expected):
    if not shutil.which("parallel"):
        skipped.append("parallel")
        return
    make_inputs(folder)
    run(folder, recipe("seq 8 | parallel"))
    check(folder, expected)
    logged = json.loads(run(folder, "frontmost render builtin:teapot --batch views.json --shard 5/8 --json"))
    if logged["finished_before"] != VIEWS // 8 or logged["views"]:
        sys.exit("parallel: the shard is not finished")


def try_slurm(folder, expected):
    run(ROOT, f"bash -n '{SLURM}'")
    if shutil.which("shellcheck"):
        run(ROOT, f"shellcheck '{SLURM}'")
    else:
        skipped.append("shellcheck")
    if "examples/slurm/render_batch.sh" not in PAGE:
        sys.exit("docs/many-machines.md does not name the script of Slurm")
    make_inputs(folder)
    for task in range(1, 4):
        run(folder, f"'{SLURM}' builtin:teapot views.json", SLURM_ARRAY_TASK_ID=str(task), SLURM_ARRAY_TASK_COUNT="3",
            SLURM_CPUS_PER_TASK="1")
    check(folder, expected)
    (folder / "0.npy").unlink()
    run(folder, f"'{SLURM}' builtin:teapot views.json", SLURM_ARRAY_TASK_ID="1", SLURM_ARRAY_TASK_COUNT="1", SHARDS="3")
    check(folder, expected)


def main():
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        make_inputs(scratch / "whole")
        run(scratch / "whole", "frontmost render builtin:teapot --batch views.json")
        expected = pictures(scratch / "whole")
        try_parallel(scratch / "parallel", expected)
        try_slurm(scratch / "slurm", expected)
    if skipped:
        print(f"{len(skipped)} skipped, as they are not installed: {', '.join(skipped)}")
        sys.exit(77)


if __name__ == "__main__":
    main()
