from build123d import Align, Box, Pos

UP = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    length, width, thickness = d["length"], d["width"], d["thickness"]
    m_in, m_out = d["mortise_in"], d["mortise_out"]
    near, far, depth = d["mortise_near"], d["mortise_far"], d["mortise_depth"]
    shape = Box(length, width, thickness, align=UP)
    mx, my = (m_in + m_out) / 2, (near + far) / 2
    for sx in (-1, 1):
        for sy in (-1, 1):
            shape -= Pos(sx * mx, sy * my, thickness - depth) * Box(m_out - m_in, far - near, depth + 1, align=UP)
    up, right = (0, 0, 1), (1, 0, 0)
    return shape, {
        "post_front": {"o": (-mx, -my, thickness - depth), "z": up, "x": right},
        "post_back": {"o": (-mx, my, thickness - depth), "z": up, "x": right},
        "gearbox": {"o": (-d["gearbox_x"], -d["gearbox_y"], thickness), "z": up, "x": right},
    }
