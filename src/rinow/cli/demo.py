"""`rinow demo`: the curvature of a small mesh that comes with the package."""

from __future__ import annotations

from pathlib import Path

from rinow.cli._terminal import print_notes, print_study, working
from rinow.cli.curvature import write_picture, write_report
from rinow.io.mesh_files import demo_mesh, write_mesh
from rinow.study.surface import study_surface

__all__ = ["demo"]

MESH, PICTURE, REPORT = Path("rinow-demo.ply"), Path("rinow-demo.png"), Path("rinow-demo.html")
TITLE = "spot (Keenan Crane, CC0)"


def demo() -> None:
    """Compute the curvature of the shipped mesh `spot`; write a PLY, a PNG and a page into the current folder."""
    with working("computing"):
        surface = demo_mesh()
        study = study_surface(surface)
    with study.timed("writing"), working("drawing"):
        write_mesh(MESH, surface, study.vertex_data(), units=study.units(), quality="gaussian")
        write_picture(PICTURE, study, "gaussian", title=TITLE, up="y")
        write_report(REPORT, study, title=TITLE, up="y")
    print_study("spot", study)
    print_notes(
        (
            f"wrote {MESH} (fields at every vertex), {PICTURE} (four views) and {REPORT} (open it in a browser) "
            f"into {Path.cwd()}.",
        )
    )
