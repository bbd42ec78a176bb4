from build123d import Align, Box, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def drawer(play, tray_long=262, wide=120, floor=3, top=10, grip=2, grip_wide=52):
    low = floor + play
    tray = Pos(1 + tray_long / 2, 0, low) * Box(tray_long, wide, top - low, align=LOW)
    tray -= Pos(1 + tray_long / 2, 0, low + 1.5) * Box(tray_long - 4, wide - 4, top, align=LOW)
    return tray + Pos(1.5 - grip / 2, 0, low) * Box(3 + grip, grip_wide, 6.5, align=LOW)
