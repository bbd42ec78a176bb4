def build(part):
    part.cylinder((0, 0, 0), "-Z", "radius", "height", name="Ring")
    part.cylinder((0, 0, 1), "-Z", "hole_radius", "height + 2", cut=True, name="Hole")
    return part.body, {"face": part.connector("face", (0, 0, 0), (0, 0, -1), (1, 0, 0))}
