from build123d import Align, Box

HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    body = Box(d["post_side"], d["post_side"], d["post_height"], align=HIGH)
    return body, {"stand": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
