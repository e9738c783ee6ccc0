"""Run by FreeCAD without a screen: makes a job (`kind` plate or indexed), posts it, and writes what came of it.

POST_JOB is JSON: kind, template of the job, arguments and output of the post-processor, `told` to be written, and `post`
where another post-processor than that of the template is asked.
"""

import json, os
import FreeCAD, Part
import Path
import PathScripts.PathCustom as PathCustom
import PathScripts.PathDrilling as PathDrilling
import PathScripts.PathJob as PathJob
import PathScripts.PathPost as PathPost
import PathScripts.PathProfile as PathProfile

asked = json.loads(os.environ["POST_JOB"])
document = FreeCAD.newDocument("Plate")
solid = document.addObject("Part::Box", "Box")
solid.Length, solid.Width, solid.Height = 60, 40, 20
for number, (x, y) in enumerate([(15, 20), (45, 20), (30, 10)]):
    hole = document.addObject("Part::Cylinder", "Hole%d" % number)
    hole.Radius, hole.Height, hole.Placement.Base = 2.5, 30, FreeCAD.Vector(x, y, -5)
    cut = document.addObject("Part::Cut", "Cut%d" % number)
    cut.Base, cut.Tool = solid, hole
    solid = cut
document.recompute()
job = PathJob.Create("Job", [solid], asked["template"])
document.recompute()
tool = job.Tools.Group[0]
tool.HorizFeed, tool.VertFeed, tool.SpindleSpeed, tool.ToolNumber = "600 mm/min", "200 mm/min", 3000, 1
if asked["kind"] == "plate":
    PathProfile.Create("Profile").CoolantMode = "Flood"
    drill = PathDrilling.Create("Drill")
    clone = job.Model.Group[0]
    round_faces = [n for n, face in enumerate(clone.Shape.Faces, 1) if isinstance(face.Surface, Part.Cylinder)]
    drill.Base = [(clone, ["Face%d" % n]) for n in round_faces]
else:
    for number, degrees in enumerate((0, 35)):
        operation = PathCustom.Create("Slot%d" % number)
        operation.ToolController = tool
        operation.Gcode = [
            "G0 Z15", "G0 X2 Y3", "G1 Z-1 F5", "G1 X12 F10", "G3 X12 Y9 I0 J3", "G0 Z15",
            "G98", "G0 X0 Y-6", "G83 X0 Y-6 Z-6 R2 Q2 F3", "G80", "G0 Z15",
        ]
        turn = FreeCAD.Rotation(FreeCAD.Vector(0.6, 0.8, 0), degrees)
        operation.Placement = FreeCAD.Placement(FreeCAD.Vector(4 * number, 0, 25), turn)
document.recompute()
job.PostProcessor, job.PostProcessorArgs = asked.get("post", job.PostProcessor), asked["arguments"]
job.PostProcessorOutputFile = asked["output"]

# The points of all cuts as FreeCAD itself places them.
points = []
for operation in job.Operations.Group:
    at = FreeCAD.Vector()
    for command in operation.Path.Commands:
        at = FreeCAD.Vector(*(command.Parameters.get(letter, before) for letter, before in zip("XYZ", at)))
        if command.Name in ("G1", "G2", "G3"):
            points.append(list(operation.Placement.multVec(at)))
post = PathPost.CommandPathPost()
objects = [item for group in post.buildPostList(job) for item in group]
failed, program, name = post.exportObjectsWith(objects, job)
with open(asked["told"], "w") as file:
    json.dump({"failed": failed, "program": program, "name": name, "points": points, "post": job.PostProcessor}, file)
