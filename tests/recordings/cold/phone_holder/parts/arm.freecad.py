def build(part):
    part.box((0, "-width / 2", "-height / 2"), ("ball_x", "width", "height"), name="Bar")
    part.cylinder(("ball_x", 0, "-cup_depth"), "+Z", "cup_radius", "cup_depth + rim", name="Cup")
    part.cylinder(("ball_x", 0, "rim"), "+Z", "relief_radius", "height", cut=True, name="Relief")
    part.sphere(("ball_x", 0, 0), "cavity_radius", cut=True, name="Cavity")
    part.box(("ball_x - slit_width / 2", "-cup_radius - 1", "-slit_depth"),
             ("slit_width", "2 * cup_radius + 2", "slit_depth + rim + 1"), cut=True, name="SlitAcross")
    part.box(("ball_x", "-slit_width / 2", "-slit_depth"),
             ("cup_radius + 1", "slit_width", "slit_depth + rim + 1"), cut=True, name="SlitEnd")
    part.box((-1, "-fork_gap / 2", "-height / 2 - 1"), ("fork_length + 1", "fork_gap", "height + 2"), cut=True, name="ForkSlot")
    part.cylinder(("pin_x", "-width / 2 - 1", 0), "+Y", "pin_radius", "width + 2", cut=True, name="PinHole")
    return part.body, {
        "root": part.connector("root", (0, "(fork_gap + width) / 4", 0), (1, 0, 0), (0, 0, 1)),
        "pin_hole": part.connector("pin_hole", ("pin_x", "-width / 2", 0), (0, -1, 0), (1, 0, 0)),
        "socket": part.connector("socket", ("ball_x", 0, 0), (0, 0, 1), (1, 0, 0)),
    }
