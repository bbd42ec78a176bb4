from build123d import Align, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
ALONG_Y = Rot(X=-90)  # turns +Z to +Y


def build(part):
    d = part.dimensions
    end = -d["grip_y"] - d["grip_seat"]
    rod = Pos(0, end, 0) * ALONG_Y * Cylinder(d["radius"], d["far_end"] - end, align=LOW)
    for y in (-d["collar_face"], d["collar_inner"]):
        rod += Pos(0, y, 0) * ALONG_Y * Cylinder(d["collar_radius"], d["collar_face"] - d["collar_inner"], align=LOW)
    connectors = {
        "axis": {"o": (0, 0, 0), "z": (0, 1, 0), "x": (0, 0, 1)},
        "grip": {"o": (0, end, 0), "z": (0, -1, 0), "x": (0, 0, 1)},
    }
    seats = {"player_1": -d["player_y"], "player_2": 0, "player_3": d["player_y"]}
    for name, y in seats.items():
        connectors[name] = {"o": (0, y, 0), "z": (0, 1, 0), "x": (0, 0, 1)}
    return rod, connectors
