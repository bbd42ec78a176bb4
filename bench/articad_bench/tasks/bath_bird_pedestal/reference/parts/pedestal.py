from build123d import Align, Cone

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    foot, head, height = d["foot"], d["head"], d["height"]
    shape = Cone(foot / 2, head / 2, height, align=LOW)
    return shape, {"basin": {"o": (0, 0, height), "z": (0, 0, 1), "x": (1, 0, 0)}}
