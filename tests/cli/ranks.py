#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""frontmost render --mpi on 1, 2, 3 and 8 ranks of this machine must give the bytes of one process. Also how failing
runs end.

    ranks.py PROGRAM          all checks except the bytes of 2 and 8 ranks
    ranks.py PROGRAM long     the bytes of 2 and 8 ranks

Without mpirun, or without the program's MPI module, all checks but that of the message are skipped, and counted.
"""
import contextlib
import json
import os
import pathlib
import random
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time

PROGRAM = pathlib.Path(sys.argv[1]).resolve()
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
MPIRUN = ["mpirun", "--oversubscribe"]
OUTPUTS = ["-o", "picture.png", "--depth", "depth.exr", "--normals", "normals.exr", "--ids", "primitive=primitives.npy",
           "--ids", "object=objects.npy", "--resolution", "160,120"]
PARTS = 8


def fail(what):
    sys.exit(f"ranks: {what}")


def triangles(seed, count):
    """Strips of neighbouring triangles with smooth normals. Some lie in one plane, so that depths are equal."""
    numbers = random.Random(seed)
    height = [numbers.choice([0, 0.25 * seed]) for _ in range(count + 2)]
    corners = [(0.2 * (i // 2), 0.4 * seed + (i % 2), height[i]) for i in range(count + 2)]
    return [corners[i:i + 3] for i in range(count)]


def write_stl(path, model):
    rows = (struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in corner), 0) for triangle in model)
    path.write_bytes(bytes(80) + struct.pack("<I", len(model)) + b"".join(rows))


def write_ply(path, model):
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {3 * len(model)}"]
    lines += [f"property float {axis}" for axis in "xyz"]
    lines += [f"element face {len(model)}", "property list uchar int vertex_indices", "end_header", ""]
    vertices = b"".join(struct.pack("<3f", *corner) for triangle in model for corner in triangle)
    faces = b"".join(struct.pack("<B3i", 3, 3 * i, 3 * i + 1, 3 * i + 2) for i in range(len(model)))
    path.write_bytes("\n".join(lines).encode() + vertices + faces)


def make_models(folder):
    for part in range(PARTS):
        model = triangles(part % 5, 0 if part == 2 else 30 + part)  # the third one is empty
        write_ply(folder / f"part-{part}.ply", model)
        write_stl(folder / f"part-{part}.stl", model)
    write_ply(folder / "one.ply", [t for part in range(PARTS) for t in triangles(part, 4000)])
    write_stl(folder / "one.stl", [t for part in range(PARTS) for t in triangles(part, 4000)])


def run(command, folder):
    return subprocess.run(command, cwd=folder, env=ENVIRONMENT, capture_output=True, text=True, timeout=900)


def done(command, folder):
    result = run(command, folder)
    if result.returncode != 0:
        fail(f"{' '.join(map(str, command))}: status {result.returncode}\n{result.stdout}{result.stderr}")
    return result


def files(folder):
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def is_about_lying(message):
    """Ranks, which never hold the whole model, do not say that it may lie on its back."""
    return "may lie on its back" in message


def words(result):
    """The program's own messages, without those of mpirun."""
    return [line for line in result.stderr.splitlines() if line.startswith("frontmost: ") and not is_about_lying(line)]


def facts(result):
    """A JSON report without times and numbers of passes."""
    report = json.loads(result.stdout)
    report["warnings"] = [warning for warning in report.get("warnings", []) if not is_about_lying(warning)]
    return {key: report[key] for key in report if key not in ("stream_passes", "timings_ms")}


def expect_same(scratch, count, mine, whole, *more):
    """`mine` on `count` ranks and `whole` in one process make the same files and print the same."""
    made = []
    for name, command in (("whole", [PROGRAM, "render", *whole]),
                          ("ranks", [*MPIRUN, "-n", str(count), PROGRAM, "render", *mine, "--mpi"])):
        folder = scratch / name
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        result = done([*command, *OUTPUTS, "--json", *more], folder)
        made.append((files(folder), words(result), facts(result)))
    if len(made[0][0]) < 5:
        fail(f"{whole}: {len(made[0][0])} files")
    if made[0] != made[1]:
        differing = [name for name in made[0][0] if made[0][0][name] != made[1][0].get(name)]
        fail(f"{mine} on {count} ranks: not the answer of one process: {differing}, {made[0][1:]}, {made[1][1:]}")


def try_bytes(scratch, counts):
    for count in counts:
        for suffix in ("ply", "stl"):
            parts = [f"../part-{part}.{suffix}" for part in range(count)]
            expect_same(scratch, count, [f"../part-{{rank}}.{suffix}"], parts)
            expect_same(scratch, count, [f"../one.{suffix}"], [f"../one.{suffix}"])


def try_mixtures(scratch):
    # Some models belong to one rank, some to all.
    mixed = ["../one.stl", "../part-{rank}.ply", "../part-0.stl"]
    expect_same(scratch, 3, mixed, ["../one.stl", *(f"../part-{part}.ply" for part in range(3)), "../part-0.stl"])
    # The camera is given, so that there is one pass; without shadows, unlit, with one sample.
    told = ["--camera-position", "3,1,9", "--camera-focal-point", "3,1,0", "--near", "1", "--far", "90", "--shading", "flat"]
    expect_same(scratch, 3, ["../part-{rank}.ply"], [f"../part-{part}.ply" for part in range(3)], *told, "--samples", "1")
    # Nothing is seen; all ranks together count the reasons.
    away = ["--camera-position", "3,1,9", "--camera-focal-point", "3,1,20", "--near", "1", "--far", "90"]
    expect_same(scratch, 3, ["../part-{rank}.ply"], [f"../part-{part}.ply" for part in range(3)], *away)


def try_batch(scratch):
    views = {"views": [{"view": "front"}, {"view": "top", "resolution": [33, 44]}], "outputs": {"output": "{view}.png"}}
    made = []
    for name, command in (("whole", [PROGRAM, "render", *(f"../part-{part}.stl" for part in range(3))]),
                          ("ranks", [*MPIRUN, "-n", "3", PROGRAM, "render", "../part-{rank}.stl", "--mpi"])):
        folder = scratch / f"batch-{name}"
        folder.mkdir()
        (folder / "views.json").write_text(json.dumps(views))
        done([*command, "--batch", "views.json"], folder)
        made.append(files(folder))
    if made[0] != made[1] or len(made[0]) != 3:
        fail("a batch: not the files of one process")


def try_recipe(scratch):
    """The matching line of docs/many-machines.md."""
    page = (pathlib.Path(__file__).resolve().parents[2] / "docs" / "many-machines.md").read_text()
    lines = [line for line in page.splitlines() if line.startswith("mpirun -n 8 frontmost render")]
    if len(lines) != 1:
        fail(f"docs/many-machines.md: {len(lines)} lines")
    variables = {**ENVIRONMENT, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "OMPI_MCA_rmaps_base_oversubscribe": "1"}
    result = subprocess.run(["bash", "-c", lines[0]], cwd=scratch, env=variables, capture_output=True, text=True, timeout=900)
    if result.returncode != 0 or not {"model.png", "depth.exr"} <= set(os.listdir(scratch)):
        fail(f"docs/many-machines.md: {result.stderr}")


def expect_failure(result, folder, status, *parts):
    """Checks that rank 0 alone prints the error, and that no file is left behind."""
    said = words(result)
    if result.returncode != status or len(said) != 1 or not all(part in said[0] for part in parts):
        fail(f"status {result.returncode}, not {status}, or not {parts}:\n{result.stderr}")
    if files(folder):
        fail(f"files were left behind: {sorted(files(folder))}")


def try_failures(scratch):
    folder = scratch / "failures"
    folder.mkdir()
    whole = (scratch / "part-1.ply").read_bytes()
    (scratch / "cut-0.ply").write_bytes(whole)
    (scratch / "cut-1.ply").write_bytes(whole)
    (scratch / "cut-2.ply").write_bytes(whole[:-20])
    command = [PROGRAM, "render", "--mpi", *OUTPUTS]
    # Rank 2 alone finds the error, after a part was read.
    expect_failure(run([*MPIRUN, "-n", "3", *command, "../cut-{rank}.ply"], folder), folder, 1, "cut-2.ply: face 29:",
                   "the file ends within the row", "(rank 2)")
    # Only some machines see the file.
    (scratch / "elsewhere").mkdir()
    shutil.copy(scratch / "one.stl", scratch / "elsewhere")
    result = run([*MPIRUN, "-n", "1", "--wdir", scratch / "elsewhere", *command, "one.stl", ":", "-n", "2", "--wdir", folder,
                  *command, "one.stl"], folder)
    expect_failure(result, folder, 1, "one.stl: cannot open", "(rank 1)")
    if sorted(files(scratch / "elsewhere")) != ["one.stl"]:
        fail("files were left behind elsewhere")
    result = run([*MPIRUN, "-n", "1", *command, "../one.stl", ":", "-n", "1", *command, "../one.stl", "--view", "top"], folder)
    expect_failure(result, folder, 2, "different command lines")
    expect_failure(run([*MPIRUN, "-n", "2", PROGRAM, "render", "--mpi", "../one.stl"], folder), folder, 2, "nothing to do")
    (folder / "nowhere").mkdir()
    result = run([*MPIRUN, "-n", "2", PROGRAM, "render", "--mpi", "../one.stl", "--batch", "/dev/null", "--shard", "1/2"], folder)
    (folder / "nowhere").rmdir()
    expect_failure(result, folder, 2, "--mpi and --shard exclude each other")


def ranks_of(mpirun, count):
    """Process ids by rank, once all ranks run."""
    end = time.monotonic() + 300
    while time.monotonic() < end:
        found = {}
        for path in pathlib.Path("/proc").iterdir():
            try:
                parent = int((path / "stat").read_text().rpartition(")")[2].split()[1])
                if parent != mpirun or (path / "exe").resolve() != PROGRAM:
                    continue
                variables = dict(v.split("=", 1) for v in (path / "environ").read_text().split("\0") if "=" in v)
                found[int(variables["OMPI_COMM_WORLD_RANK"])] = int(path.name)
            except (OSError, ValueError, KeyError, IndexError):
                continue
        if len(found) == count:
            return found
        time.sleep(0.01)
    fail("the ranks did not start")


def with_a_stopped_rank(folder, stopped, act, *more):
    """Stops rank `stopped` as soon as it runs, so that the others wait for it; `act` gets the ranks."""
    command = [*MPIRUN, "-n", "2", PROGRAM, "render", "--mpi", "../one.stl", *OUTPUTS, *more]
    with subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE) as process:
        ranks = ranks_of(process.pid, 2)
        os.kill(ranks[stopped], signal.SIGSTOP)
        act(ranks)
        try:
            errors = process.communicate(timeout=900)[1]
        except subprocess.TimeoutExpired:
            process.kill()
            fail("the ranks hang")
    if process.returncode == 0 or files(folder):
        fail(f"status {process.returncode}, files {sorted(files(folder))}")
    return errors


def try_death(scratch):
    folder = scratch / "death"
    folder.mkdir()

    def kill_other(ranks):
        os.kill(ranks[1], signal.SIGKILL)
        time.sleep(0.2)
        with contextlib.suppress(ProcessLookupError):  # ended already
            os.kill(ranks[0], signal.SIGCONT)

    errors = with_a_stopped_rank(folder, 0, kill_other)
    if "rank 1" not in errors or "signal 9" not in errors:
        fail(f"a rank that dies: {errors}")


def try_timeout(scratch):
    folder = scratch / "timeout"
    folder.mkdir()
    errors = with_a_stopped_rank(folder, 1, lambda ranks: None, "--timeout", "6")
    if "frontmost: gave up after 6 s (--timeout), waiting for other ranks\n" not in errors:
        fail(f"--timeout: {errors}")


def try_without_module(scratch):
    """Checks the message of a program that was installed without the module."""
    alone = scratch / "alone"
    alone.mkdir()
    shutil.copy(PROGRAM, alone / "frontmost")
    result = run([alone / "frontmost", "render", "builtin:teapot", "--mpi", "-o", "a.png"], alone)
    if result.returncode != 1 or "frontmost_mpi.so is missing; install the package frontmost-mpi" not in result.stderr:
        fail(f"without the module: {result.returncode}, {result.stderr}")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        make_models(scratch)
        try_without_module(scratch)
        if not shutil.which("mpirun") or not (PROGRAM.parent / "frontmost_mpi.so").exists():
            print("7 skipped, as MPI is not installed: bytes, mixtures, batch, recipe, failures, death, timeout")
            sys.exit(77)
        if sys.argv[2:] == ["long"]:
            return try_bytes(scratch, (2, 8))
        try_bytes(scratch, (1, 3))
        try_mixtures(scratch)
        try_batch(scratch)
        try_recipe(scratch)
        try_failures(scratch)
        try_death(scratch)
        try_timeout(scratch)


if __name__ == "__main__":
    main()
