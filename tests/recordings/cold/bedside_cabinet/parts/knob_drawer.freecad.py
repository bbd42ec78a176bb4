def build(part):
    part.cylinder((0, 0, 0), "-Y", "neck_radius", "neck_length", name="Neck")
    part.cylinder((0, "-neck_length", 0), "-Y", "head_radius", "length - neck_length", name="Head")
    part.cylinder((0, 0, 0), "+Y", "spigot_radius", "spigot_length", name="Spigot")
    part.settle()
    part.fillet("-Y", "edge_fillet")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (0, -1, 0), (1, 0, 0)),
    }
