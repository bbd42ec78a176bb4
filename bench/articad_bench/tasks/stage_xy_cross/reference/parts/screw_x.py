from build123d import Align, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    diameter, length, out, collar, collar_width = d["diameter"], d["length"], d["out"], d["collar"], d["collar_width"]
    bracket, play, knob, knob_width = d["bracket"], d["play"], d["knob"], d["knob_width"]
    shape = Pos(0, 0, -length) * Cylinder(diameter / 2, length + out, align=LOW) + Pos(0, 0, out) * Cylinder(knob / 2, knob_width, align=LOW)
    shape += Pos(0, 0, play) * Cylinder(collar / 2, collar_width, align=LOW) + Pos(0, 0, -bracket - play) * Cylinder(collar / 2, collar_width, align=HIGH)
    return shape, {"bearing": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (0, 1, 0)}}
