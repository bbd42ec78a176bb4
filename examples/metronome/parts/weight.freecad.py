def build(part):
    low, top = "bottom_width / 2", "top_width / 2"
    outline = part.sketch("XZ", name="BlockSketch")
    part.polygon(outline, [(f"-{low}", 0), (low, 0), (top, "height"), (f"-{top}", "height")])
    part.pad(outline, "depth", both=True, name="Block")
    part.fillet("-Y", 1, name="FrontEdges")
    part.box(("-slot_width / 2", "-slot_depth / 2", -1), ("slot_width", "slot_depth", "height + 2"), cut=True, name="Slot")
    return part.body, {"hole": part.connector("hole", (0, 0, 0), (0, 0, 1), (1, 0, 0))}
