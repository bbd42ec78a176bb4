def build(part):
    part.cylinder((0, 0, 0), "-Z", "radius", "height", name="Foot")
    part.fillet("-Z", "edge_radius", name="Edge")
    part.cylinder((0, 0, 0), "+Z", "spigot_radius", "spigot_length", name="Spigot")
    return part.body, {"top": part.connector("top", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
