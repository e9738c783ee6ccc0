"""A second opinion on ``post clearance``: bodies of a machine along an NC program, by other means.

Nothing of post is used but the NC text. The machine file is read by tomllib; links are moved by the matrices that move
them on the machine, from the bed outward, and not by the chain from the part to the tool; distances are those of
python-fcl between meshes, at samples of each block. Round bodies are inscribed polygons: meshes are never nearer than
their bodies, so that a distance which is proven and is more than one of meshes is wrong, whatever the polygon. It is at
most ``Body.error`` more for each of two bodies.
"""
