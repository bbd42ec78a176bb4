def build(part):
    part.cylinder(("-thickness / 2", 0, 0), "+X", "big_eye_radius", "thickness", name="BigEye")
    part.box(("-thickness / 2", "-shank_width / 2", "-length"), ("thickness", "shank_width", "length"), name="Shank")
    part.cylinder(("-thickness / 2", 0, "-length"), "+X", "small_eye_radius", "thickness", name="SmallEye")
    part.cylinder(("-thickness / 2 - 1", 0, 0), "+X", "big_bore_radius", "thickness + 2", cut=True, name="BigBore")
    part.cylinder(("-thickness / 2 - 1", 0, "-length"), "+X", "small_bore_radius", "thickness + 2", cut=True, name="SmallBore")
    return part.body, {
        "big_eye": part.connector("big_eye", (0, 0, 0), (1, 0, 0), (0, 0, 1)),
        "small_eye": part.connector("small_eye", (0, 0, "-length"), (1, 0, 0), (0, 0, 1)),
    }
