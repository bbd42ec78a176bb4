def build(part):
    part.box(("-length / 2", "-depth / 2", 0), ("length", "depth", "thickness"), name="Plate")
    part.cylinder((0, 0, 0), "+Z", "boss_radius", "thickness + boss_height", name="AnvilBoss")
    part.cylinder(("-column_x", 0, "thickness"), "-Z", "socket_radius", "socket_depth", cut=True, name="SocketLeft")
    part.cylinder(("column_x", 0, "thickness"), "-Z", "socket_radius", "socket_depth", cut=True, name="SocketRight")
    holes = part.sketch("XY", at=(0, 0, 0))
    part.circle(holes, "hole_x", "hole_y", "hole_radius")
    part.circle(holes, "-hole_x", "hole_y", "hole_radius")
    part.circle(holes, "hole_x", "-hole_y", "hole_radius")
    part.circle(holes, "-hole_x", "-hole_y", "hole_radius")
    part.pocket(holes)
    return part.body, {
        "column_left": part.connector("column_left", ("-column_x", 0, "thickness"), (0, 0, 1), (1, 0, 0)),
        "column_right": part.connector("column_right", ("column_x", 0, "thickness"), (0, 0, 1), (1, 0, 0)),
    }
