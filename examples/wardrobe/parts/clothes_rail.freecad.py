def build(part):
    part.cylinder((0, 0, 0), "+X", "radius", "length", name="Tube")
    part.cylinder((0, 0, 0), "+X", "radius - wall", "length", cut=True, name="Inside")
    return part.body, {"end": part.connector("end", (0, 0, 0), (1, 0, 0), (0, 0, 1))}
