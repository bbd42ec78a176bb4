def build(part):
    part.cylinder((0, 0, 0), "+Z", "radius", "height", name="Column")
    part.cylinder((0, 0, 0), "-Z", "spigot_radius", "spigot_low", name="LowerSpigot")
    part.cylinder((0, 0, "height"), "+Z", "spigot_radius", "spigot_high", name="UpperSpigot")
    return part.body, {
        "foot": part.connector("foot", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "top": part.connector("top", (0, 0, "height"), (0, 0, 1), (1, 0, 0)),
    }
