def build(part):
    part.box(("-bar_length / 2", "-depth / 2", 0), ("bar_length", "depth", "bar_height"), name="Crossbar")
    part.box(("cheek_start", "-depth / 2", 0), ("cheek_end - cheek_start", "depth", "axis_z"), name="Cheek")
    part.cylinder(("cheek_start", 0, "axis_z"), "+X", "depth / 2", "cheek_end - cheek_start", name="CheekTop")
    part.box(("-guide_size / 2", "-guide_size / 2", -1), ("guide_size", "guide_size", "bar_height + 2"), cut=True, name="RamGuide")
    part.cylinder(("-column_x", 0, 0), "+Z", "socket_radius", "socket_depth", cut=True, name="SocketLeft")
    part.cylinder(("column_x", 0, 0), "+Z", "socket_radius", "socket_depth", cut=True, name="SocketRight")
    part.cylinder(("cheek_start - 1", 0, "axis_z"), "+X", "bore_radius", "cheek_end - cheek_start + 2", cut=True, name="BearingBore")
    return part.body, {
        "seat_left": part.connector("seat_left", ("-column_x", 0, 0), (0, 0, 1), (1, 0, 0)),
        "bearing": part.connector("bearing", ("cheek_start", 0, "axis_z"), (1, 0, 0), (0, 0, 1)),
        "guide": part.connector("guide", (0, 0, "bar_height"), (0, 0, -1), (1, 0, 0)),
    }
