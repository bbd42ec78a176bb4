from build123d import Align, Box, Pos


def build(part):
    d = part.dimensions
    wall, deep, wide = d["wall"], d["depth"], d["goal_width"]
    corner = (Align.MAX, Align.CENTER, Align.MIN)
    goal = Pos(0, 0, -wall) * Box(deep + wall, wide + 2 * wall, d["height"] + wall, align=corner)
    goal -= Box(deep, wide, 2 * d["height"], align=corner)
    return goal, {"mouth": {"o": (0, 0, 0), "z": (-1, 0, 0), "x": (0, 0, 1)}}
