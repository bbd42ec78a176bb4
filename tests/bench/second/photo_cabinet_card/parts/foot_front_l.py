from build123d import Align, Cylinder

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def foot_front_l(foot_high, spigot, spigot_long, foot=40):
    return Cylinder(foot / 2, foot_high, align=LOW) + Cylinder(spigot / 2, foot_high + spigot_long, align=LOW)
