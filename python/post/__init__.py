"""Posts cutter-location files, and solves the kinematics of the machines that run them.

Lengths are in mm and angles in degrees, as the control shows them; points and tool axes are in the part frame; arrays
are float64, one row a point, axis values in the order of :attr:`Machine.axes`.
"""

from post.machine import Axis, Machine, job
from post.made import Blocks, Found, Job
from post.refusal import Diagnostic, PostError
from post.studies import Study, study

__all__ = [
    "Axis",
    "Blocks",
    "Diagnostic",
    "Found",
    "Job",
    "Machine",
    "PostError",
    "Study",
    "job",
    "study",
]
