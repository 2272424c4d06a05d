"""The command line where something is wrong or somebody leaves: one line that says what to do, nothing half done."""

import errno
import json
import os
import shlex
import subprocess
import sys

import numpy as np
import pytest

import rinow
import shapes
from rinow.cli.main import main

POINTS = np.random.default_rng(17).normal(size=(5, 3))


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    sphere = shapes.icosphere(1)
    rinow.write_mesh("ball.ply", rinow.TriangleMesh(sphere.vertices, sphere.faces))
    np.savetxt("points.csv", POINTS, delimiter=",")
    np.savetxt("distances.csv", rinow.MetricSpace.from_points(POINTS).distances, delimiter=",")
    return tmp_path


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (
            "curvature",
            'Command "curvature" parameter MESH requires an argument. rinow curvature --help lists the arguments.',
        ),
        ("info ball.ply more.ply", "more.ply is more than rinow info takes. rinow info --help lists the arguments."),
        ("curvature ball.ply --radius wide", 'Invalid value for --radius: unable to convert "wide" into float.'),
        ("curvature -", "- names no file, and rinow reads and writes files only, no pipes;"),
        ("curvature ball.ply -o -", "- names no file"),
        ("nonsense", 'Unknown command "nonsense". Available commands: demo, info, curvature,'),
    ],
)
def test_wrong_usage_is_one_line(folder, capsys, words, sentence):
    assert main(words.split()) == 2
    out = capsys.readouterr()
    assert out.out == ""
    assert out.err.startswith(f"rinow: {sentence}")
    assert out.err.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("features points.csv", "points.csv has no faces; creases are found on a mesh."),
        ("net points.csv --size 2", "points.csv has no faces; geodesic distances need a mesh"),
        (
            "compare points.csv distances.csv",
            "points.csv has no faces; add --points if its rows are points, --distances",
        ),
        ("compare ball.ply points.csv", "points.csv has no faces; add --points"),
        (
            "curvature distances.csv",
            "distances.csv holds the distances of 5 points, not their places; add --distances",
        ),
        ("info distances.csv", "distances.csv holds the distances of 5 points"),
        ("curvature empty.csv", "empty.csv: the file is empty"),
        ("net empty.csv --size 2", "empty.csv: the file is empty"),
        ("curvature ball.ply -o out.docx", "out.docx has no suffix of a known mesh format (.ply"),
    ],
)
def test_a_file_of_another_kind_is_told_by_name(folder, capsys, words, sentence):
    (folder / "empty.csv").touch()
    assert main(words.split()) == 1
    assert capsys.readouterr().err.removeprefix("rinow: ").removeprefix("B: ").startswith(sentence)


def test_a_reader_who_has_seen_enough_is_no_error(folder):
    code = "import sys; from rinow.cli.main import run; sys.argv[1:] = ['info', 'ball.ply']; run()"
    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as run:
        run.stdout.close()
        assert run.stderr.read() == b""
        assert run.wait() == 0


def test_ctrl_c_while_a_file_is_written_leaves_none_and_says_nothing(folder, capsys, monkeypatch):
    def interrupted(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("os.replace", interrupted)
    before = sorted(path.name for path in folder.iterdir())
    assert main(["curvature", "ball.ply", "-o", "out.ply"]) == 130
    assert capsys.readouterr().err == ""
    assert sorted(path.name for path in folder.iterdir()) == before


RUN = "import sys; from rinow.cli.main import run; sys.argv[1:] = {words!r}; run()"


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")
@pytest.mark.parametrize("words", [["info", "ball.ply"], ["info", "ball.ply", "--json"], ["info", "--help"]])
def test_a_full_disk_behind_stdout_is_one_line(folder, words):
    with open("/dev/full", "wb") as full:
        done = subprocess.run(
            [sys.executable, "-c", RUN.format(words=words)], stdout=full, stderr=subprocess.PIPE, text=True, check=False
        )
    assert done.returncode == 1
    assert (
        done.stderr
        == f"rinow: the output cannot be written: {os.strerror(errno.ENOSPC)}; make room or send it elsewhere.\n"
    )


def test_a_locale_without_letters_of_the_output_gets_the_rest(folder):
    (folder / "ball.ply").rename("b\u00e4ll.ply")
    done = subprocess.run(
        [sys.executable, "-c", RUN.format(words=["curvature", "b\u00e4ll.ply", "--method", "angle_defect"])],
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert b"b?ll.ply" in done.stdout
    assert b"1/length?" in done.stdout


@pytest.mark.skipif(os.name != "posix", reason="closes a descriptor as shells of POSIX do")
def test_a_closed_stdout_is_no_error(folder):
    command = shlex.join([sys.executable, "-c", RUN.format(words=["info", "ball.ply"])]) + " >&-"
    done = subprocess.run(["sh", "-c", command], stderr=subprocess.PIPE, check=False)
    assert (done.returncode, done.stderr) == (0, b"")


def test_a_signal_to_end_leaves_no_file_half_written(folder):
    code = (
        "import os, signal, sys, rinow.cli.main\n"
        "os.replace = lambda *_: os.kill(os.getpid(), signal.SIGTERM)\n"
        "sys.argv[1:] = ['curvature', 'ball.ply', '-o', 'out.ply']\n"
        "rinow.cli.main.run()"
    )
    before = sorted(path.name for path in folder.iterdir())
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (143, b"", b"")
    assert sorted(path.name for path in folder.iterdir()) == before


@pytest.mark.parametrize("length", ["1e-170", "1e-155", "1e155", "1e170"])
def test_a_unit_in_which_curvatures_are_no_numbers_is_refused(capsys, length):
    for words in ([length] * 6, [length, "0", length, length, "0", length]):
        assert main(["quadruple", *words]) == 1
        out = capsys.readouterr()
        assert out.out == ""
        assert out.err.startswith("rinow: distances up to 1e")
        assert out.err.endswith("give them in a unit in which they are near 1.\n")


@pytest.mark.parametrize("length", ["1e-150", "1e150"])
def test_far_units_give_finite_coordinates(capsys, length):
    assert main(["quadruple", *[length] * 6, "--json"]) == 0
    values = json.loads(capsys.readouterr().out)["values"]
    assert len(values) == 1
    assert np.isfinite(np.array(values[0]["coordinates"], float)).all()


def test_help_says_nothing_of_flags_that_are_off(capsys):
    assert main(["compare", "--help"]) == 0
    out = capsys.readouterr().out
    assert "--json" in out
    assert "--output -o" in out
    assert "[default: False]" not in out
