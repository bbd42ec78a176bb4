def build(part):
    low, top, line = "bottom_width / 2", "top_width / 2", 0.4  # half a line's width
    outline = part.sketch("XZ", name="PlateSketch")
    part.polygon(outline, [(f"-{low}", 0), (low, 0), (top, "height"), (f"-{top}", "height")])
    part.pad(outline, "thickness", name="Plate")
    part.cylinder((0, 1, "bore_z"), "-Y", "bore_radius", "thickness + 2", cut=True, name="Bore")

    # every second line on the left, the others on the right, cut from the middle to the edge; then their ends are filled again
    front, deep, pitch = (0, "-thickness", 0), "thickness / 5", "(last_mark - first_mark) / (mark_count - 1)"
    sides = (("Left", "-bottom_width", "first_mark", "ceil(mark_count / 2)"), ("Right", 0, f"first_mark + {pitch}", "floor(mark_count / 2)"))
    for side, x, z, count in sides:
        sketch = part.sketch("XZ", front, name=f"{side}LineSketch")
        part.rectangle(sketch, x, f"{z} - {line}", "bottom_width", 2 * line)
        mark = part.pocket(sketch, deep, name=f"{side}Line")
        part.linear_pattern([mark], "Z", f"2 * {pitch} * ({count} - 1)", count)

    def half(z):
        return f"({low} + ({top} - {low}) * ({z}) / height)"

    under, over = f"first_mark - {2 * line}", f"last_mark + {2 * line}"
    ends = part.sketch("XZ", front, name="EndsSketch")
    inner = [(f"0.2 * {half(z)} + 1", z) for z in (under, over)]
    outer = [(f"0.8 * {half(z)} + 1", z) for z in (under, over)]
    edge = [(half(z), z) for z in (under, over)]
    part.polygon(ends, [(f"-({inner[0][0]})", under), inner[0], inner[1], (f"-({inner[1][0]})", over)])
    part.polygon(ends, [outer[0], edge[0], edge[1], outer[1]])
    part.polygon(ends, [(f"-({x})", z) for x, z in (outer[0], outer[1], edge[1], edge[0])])
    part.pad(ends, deep, back=True, name="Ends")

    axis = part.sketch("XZ", front, name="AxisSketch")
    part.rectangle(axis, -line, "first_mark", 2 * line, "last_mark - first_mark")
    part.pocket(axis, deep, name="Axis")
    return part.body, {"back": part.connector("back", (0, 0, 0), (0, -1, 0), (1, 0, 0))}
