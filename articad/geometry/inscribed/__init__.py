"""Convex pieces inside a solid: collision shapes that touch nothing that the solid does not touch.

Each piece is an intersection of half-spaces, grown around a seed point. For each triangle of the surface, some plane of the piece has
the whole triangle on its far side. So no surface point is inside the piece. The piece is connected and its seed is inside the solid,
hence so is the piece.

1. Seeds: from points of the surface, half-way through the material along the inward normal. The whole surface must enclose them: its
winding number about a seed is at least 1. So surfaces that cross or repeat themselves have pieces only where they enclose material.
2. Growth (as in IRIS, Deits and Tedrake 2015, without the ellipsoid): the triangle nearest to the seed gives a plane, all triangles
beyond that plane are done, and so on until none is left. The plane is the triangle's own one, so that flat faces are exact and bores get
tangent planes, or else the plane through its nearest point. In front of convex round surfaces the plane moves inwards a little, so that
one plane serves many facets.
3. Choice: the next seeds belong to the surface point that is farthest from all pieces, until each is within the bound. All pieces that
were ever grown are candidates, and the one that covers most points is taken. If there are too many, a greedy set cover chooses among all
candidates, for the least bound that the permitted number of pieces reaches.

Balls and cylinders are recognised by their faces and used whole if they lie inside; pieces with six perpendicular planes are boxes.
"""

from articad.geometry.inscribed.cover import MOST_PIECES, SCHEME, Inscribed, inscribed, missing_bound
from articad.geometry.inscribed.piece import Piece
from articad.geometry.inscribed.surface import INSIDE_MM

__all__ = ["INSIDE_MM", "MOST_PIECES", "SCHEME", "Inscribed", "Piece", "inscribed", "missing_bound"]
