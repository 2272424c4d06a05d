"""Files in and out; paths are known here only.

By kind of content
    `mesh_files` with their `fields`, `point_files`, `tables`; the suffix of a name decides the format.
Formats
    `ply` with `ply_header` and `ply_body`, `obj`, `off`, `stl`, `npz`; through other libraries `glb`, `gifti`,
    `freesurfer`, `vtk` with `vtk_legacy`.
For all of them
    `atomic` writes whole files or none, `faults` names what is wrong, `polygons` become triangles, `text_numbers`.
"""
