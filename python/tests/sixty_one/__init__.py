"""Sixty-one machines of the trade, written from data sheets, with kinematics that post knows nothing of.

- ``NAME.toml``: a machine file each, as its builder would write it;
- ``table``: the same machines as bodies that move one another, written apart from these files;
- ``kinematics``: the product that moves them; ``struts``: what papers and makers publish of parallel machines and arms;
- ``passes``: CL files that fit their freedoms; ``words``: a reader of programs;
- ``verdict``: posts, reads, moves and compares; ``page``: the table in the book.

Nothing here imports post or the oracle of the other tests.
"""
