"""Programs that run inside FreeCAD's own process and know nothing of articad: files in, files out."""
