"""Programs that run inside FreeCAD's own process and do not import articad: files in, files out."""
