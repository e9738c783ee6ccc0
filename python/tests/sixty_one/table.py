"""The 61 machines as who stands beside them sees them: written from data sheets, not from the machine files beside this.

A table that carries the part is told by how it goes itself. ISO 841 counts the tool as seen from the part, so that of most
makes a table turns clockwise, seen from the tip of its direction, as its word counts up: ``down`` below. Positions are in mm
from where the maker's drawing has them, all words at rest.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from sixty_one import passes, struts
from sixty_one.kinematics import Bodies, Joint, Vector, slides, turns
from sixty_one.passes import Work

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)


def down(way: Vector) -> Vector:
    """The other way about."""
    return (-way[0], -way[1], -way[2])


@dataclass(frozen=True)
class Lack:
    """A work that is refused, by what the message says: where it is not any more, the table is old."""

    work: Work
    why: str
    options: tuple[str, ...] = ()


@dataclass(frozen=True)
class Machine:
    """A row of the table. ``kind`` is what it is called in the field, ``told`` what its program says, ``before`` what was
    said of its kind in June, by the item of the list that asked for it."""

    name: str
    model: str
    kind: str
    dialect: str
    told: str
    bodies: Bodies
    work: Work
    before: str = "worked"
    after: str = "works"
    length: float = 100.0
    tips: bool = False
    """The control keeps the tip: X Y Z of the program are the tip's."""
    tolerance: float = 0.005
    lean: float = 0.05
    drives: tuple[tuple[str, struts.Law], ...] = ()
    """Joints behind the words by their names, by formulas that others published."""
    vectors: bool = False
    """The program says the tool's direction itself."""
    options: tuple[str, ...] = ()
    """What the command is told besides."""
    but: str = ""
    lacks: Lack | None = None
    idle: str = ""
    """Joints that stand still in its work, or whose way its program does not show."""
    """What of it does not work, where it works in part, and the command that shows it."""
    second: Bodies | None = field(default=None)
    """What its second channel leads, whose machine file and work are named so."""


def mill(part: tuple[Joint, ...], tool: tuple[Joint, ...], nose: float, origin: Vector, **more: object) -> Bodies:
    """A spindle that stands upright."""
    return Bodies(part, tool, origin, (0.0, 0.0, nose), **more)  # type: ignore[arg-type]


HEAD = (slides("X", *X), slides("Y", *Y), slides("Z", *Z))
"""The tool goes along all three, the part stands."""
CROSS = (slides("Y", 0, -1, 0), slides("X", -1, 0, 0))
"""A table on a saddle: as X counts up the table goes to the left, as Y does to the front."""

ROWS = [
    Machine("haas-vf2", "Haas VF-2", "mill of three axes", "haas", "X Y Z",
            mill(CROSS, (slides("Z", *Z),), 610, (0, 0, 60)), passes.flat()),
    Machine("brother-s700x1", "Brother SPEEDIO S700X1", "mill of three axes", "brother", "X Y Z",
            mill(CROSS, (slides("Z", *Z),), 480, (0, 0, 120)), passes.flat()),
    Machine("shapeoko-4", "Carbide 3D Shapeoko 4 XXL", "router, gantry", "grbl", "X Y Z",
            Bodies((), (slides("Y", *Y), slides("X", *X), slides("Z", *Z)), (0, 0, 10), (419, 419, 120)),
            passes.flat(size=25), length=40),
    Machine("deckel-fp4", "Deckel FP 4 NC", "mill, spindle across Z", "linuxcnc", "X Y Z, Z up as the knee rises",
            Bodies((slides("Z", *Z),), (slides("Y", *Y), slides("X", *X)), (0, 0, 0), (0, 80, 0), Y),
            passes.flat(Y, 25), "item 12"),
    Machine("haas-vf4-hrt210", "Haas VF-4 with HRT210", "fourth axis A on the table", "haas", "X Y Z A",
            mill((*CROSS, turns("A", down(X), (0, 0, 152.4))), (slides("Z", *Z),), 737, (0, 0, 152.4)),
            passes.around(X, Z)),
    Machine("mori-nhx4000", "DMG MORI NHX 4000", "horizontal, B turns in cuts", "fanuc", "X Y Z B",
            Bodies((slides("Z", 0, 0, -1), turns("B", down(Y))), (slides("X", *X), slides("Y", *Y)), (0, 100, 0), (0, 350, 730)),
            passes.around(Y, Z, radius=90)),
    Machine("makino-a51", "Makino a51", "horizontal, B indexes", "fanuc", "X Y Z B",
            Bodies((slides("Z", 0, 0, -1), turns("B", down(Y))), (slides("X", *X), slides("Y", *Y)), (0, 100, 0), (0, 400, 750)),
            passes.sided()),
    Machine("tos-whn13", "TOS WHN 13 CNC", "boring mill with W", "heidenhain", "X Y Z W B",
            Bodies((slides("Z", 0, 0, -1), slides("X", -1, 0, 0), turns("B", down(Y))), (slides("Y", *Y), slides("W", *Z)),
                   (0, 300, 0), (0, 300, 1800)), passes.sided(radius=150), tolerance=0.01),
    Machine("mazak-variaxis-i600", "Mazak VARIAXIS i-600", "trunnion A C", "mazak", "tip, A C",
            mill((turns("A", down(X), (0, 0, 80)), turns("C", down(Z))), HEAD, 560, (0, 0, 40)), passes.dome(), tips=True),
    Machine("grob-g350", "GROB G350", "horizontal, tables A and B", "siemens", "tip, A B",
            mill((turns("A", down(X)), turns("B", down(Y))), HEAD, 900, (0, 60, 0)), passes.dome(Y), tips=True),
    Machine("haas-umc750", "Haas UMC-750", "trunnion B C", "haas", "tip, B C",
            mill((turns("B", down(Y), (0, 0, 50.8)), turns("C", down(Z))), HEAD, 560, (0, 0, 30)), passes.dome(), tips=True),
    Machine("matsuura-mx520", "Matsuura MX-520", "trunnion A C as measured", "fanuc", "X Y Z A C",
            mill((turns("A", down(X), (0, 0.02, 50)), turns("C", down(Z))), HEAD, 550, (0, 0, 40)), passes.dome()),
    Machine("okuma-mu5000v", "Okuma MU-5000V", "trunnion A C", "okuma", "tip, A C",
            mill((turns("A", down(X), (0, 0, 70)), turns("C", down(Z))), HEAD, 650, (0, 0, 40)), passes.dome(), tips=True),
    Machine("hurco-vmx30ui", "Hurco VMX30Ui", "trunnion A C on a cross table", "hurco", "X Y Z A C",
            mill((*CROSS, turns("A", down(X), (0, 0, 30)), turns("C", down(Z))), (slides("Z", *Z),), 560, (0, 0, 30)),
            passes.dome()),
    Machine("dmg-dmu65", "DMG MORI DMU 65 monoBLOCK", "trunnion A C, vectors", "siemens", "tip, A3 B3 C3",
            mill((turns("A", down(X), (0, 0, -20)), turns("C", down(Z))), HEAD, 620, (0, 0, 40)), passes.dome(), "item 3",
            tips=True, vectors=True),
    Machine("syil-u5", "SYIL U5", "trunnion A C", "syntec", "tip, A C",
            mill((turns("A", down(X), (0, 0, 35)), turns("C", down(Z))), HEAD, 360, (0, 0, 30)), passes.dome(radius=25),
            tips=True, length=60),
    Machine("zimmermann-fz33", "Zimmermann FZ33", "gantry, head of three axes", "siemens", "tip, A B C",
            mill((), (*HEAD, turns("C", Z), turns("B", Y, (0, 0, 1500)), turns("A", X, (0, 0, 1500))), 1300, (0, 0, 200)),
            passes.dome(), tips=True, tolerance=0.01),
    Machine("breton-matrix", "Breton Matrix 1000", "gantry, fork A C", "fanuc", "X Y Z A C",
            mill((), (slides("Y", *Y), slides("X", *X), slides("Z", *Z), turns("C", Z), turns("A", X, (0, 0.05, 1380))), 1150,
                 (0, 0, 250)), passes.dome(), tolerance=0.01),
    Machine("cms-ares", "CMS Ares 37-26", "router, fork B C", "isg", "tip, B C",
            mill((), (*HEAD, turns("C", Z), turns("B", Y, (0, 0, 1610))), 1400, (0, 0, 200)), passes.dome(), tips=True,
            tolerance=0.02),
    Machine("zayer-arion", "Zayer Arion", "head C and A at 45 degrees", "fagor", "X Y Z A C",
            mill((), (*HEAD, turns("C", Z), turns("A", (1, 0, 1), (0, 0, 1350))), 1100, (0, 0, 200)), passes.dome(),
            tolerance=0.01),
    Machine("biesse-rover", "Biesse Rover", "head C and B at 50 degrees", "isg", "X Y Z B C",
            mill((), (*HEAD, turns("C", Z), turns("B", (0, float(np.sin(np.radians(50))), float(np.cos(np.radians(50)))), (0, 0, 900))),
                 740, (0, 0, 200)), passes.dome(most=80, radius=25), tolerance=0.02),
    Machine("dmg-dmu125p", "DMG MORI DMU 125 P duoBLOCK", "nutating head B, table C", "siemens", "tip, B C",
            mill((turns("C", down(Z)),), (*HEAD, turns("B", (0, 1, 1), (0, 0, 1000))), 800, (0, 0, 100)), passes.dome(most=60),
            tips=True),
    Machine("dmg-dmu50evo", "Deckel Maho DMU 50 evolution", "nutating table B, C", "heidenhain", "tip, B C",
            mill((turns("B", (0, -1, -1), (0, 0, -60)), turns("C", down(Z))), HEAD, 420, (0, 0, 20)), passes.dome(), tips=True,
            length=80),
    Machine("liechti-turbomill", "Starrag Liechti Turbomill 800g", "head B, part A", "siemens", "tip, A B",
            mill((slides("X", -1, 0, 0), turns("A", down(X))), (slides("Y", *Y), slides("Z", *Z), turns("B", Y, (0, 0, 700))), 450,
                 (0, 0, 0)), passes.around(X, Z), tips=True),
    Machine("matec-30hv", "Matec 30 HV", "head B, table C", "heidenhain", "tip, B C",
            mill((turns("C", down(Z)),), (*HEAD, turns("B", Y, (0, 0, 900))), 700, (0, 0, 100)), passes.dome(), tips=True),
    Machine("willemin-408mt", "Willemin-Macodel 408MT", "part A, swivel B between Y and Z", "fanuc", "X Y Z A B",
            mill((turns("A", down(X)),), (slides("X", *X), slides("Y", *Y), turns("B", Y, (0, 0, 420)), slides("Z", *Z)), 260,
                 (0, 0, 0)), passes.around(X, Z, radius=15), "item 12", length=60),
    Machine("haas-st20", "Haas ST-20", "lathe X Z", "fanuc", "diameters, Z",
            Bodies((), (slides("Z", *Z), slides("X", *X)), (0, 0, 120), (230, 0, 640), Z, factors={"X": 2.0}), passes.turned(),
            "item 4", "in part", length=40,
            but="dialect `haas` has no words of a lathe (G96 is refused, a tool is called by T1 M6): posted as Fanuc, system A"),
    Machine("dmg-ctx310", "DMG MORI CTX 310", "lathe X Z C, TRANSMIT", "siemens", "diameters, Z C; X Y in the mode",
            Bodies((turns("C", down(Z)),), (slides("Z", *Z), slides("X", *X)), (0, 0, 150), (190, 0, 560), Z, factors={"X": 2.0}),
            passes.face(), "items 1, 2, 4", tolerance=0.01),
    Machine("doosan-puma2600", "DN Solutions PUMA 2600M", "lathe X Z C, cylinder", "fanuc", "X Z C, G7.1",
            Bodies((turns("C", down(Z)),), (slides("Z", *Z), slides("X", *X)), (0, 0, 150), (320, 0, 600), X),
            passes.around(Z, X, radius=30, climb=-20), "items 1, 4", tolerance=0.01),
    Machine("mori-nl2000", "Mori Seiki NL2000Y", "lathe X Z C Y", "fanuc", "diameters, Y Z C",
            Bodies((turns("C", down(Z)),), (slides("Z", *Z), slides("X", *X), slides("Y", *Y)), (0, 0, 150), (320, 0, 500), X,
                   factors={"X": 2.0}), passes.beside(), "item 2", tolerance=0.01),
    Machine("mazak-integrex-i200", "Mazak INTEGREX i-200", "mill-turn with B, Y", "mazak", "tip, B C",
            Bodies((turns("C", down(Z)),), (slides("Z", *Z), slides("X", *X), slides("Y", *Y), turns("B", Y, (640, 0, 250), 90.0)),
                   (0, 0, 150), (420, 0, 250), X), passes.dome((1, 0, 0.4), radius=30), tips=True),
    Machine("okuma-multus-b200", "Okuma MULTUS B200 without Y", "mill-turn X Z B C", "fanuc", "X Z B C",
            Bodies((turns("C", down(Z)),), (slides("Z", *Z), slides("X", *X), turns("B", Y, (380, 0, 800))), (0, 0, 100),
                   (380, 0, 620), Z), passes.meridian(), "item 1", tolerance=0.01),
    Machine("nakamura-wt150", "Nakamura-Tome WT-150", "lathe of two channels", "fanuc", "diameters, Z; M100 waits",
            Bodies((), (slides("Z", *Z), slides("X", *X)), (0, 0, 100), (148, 0, 290), Z, factors={"X": 2.0}),
            passes.waiting(1), "item 11", length=40,
            second=Bodies((), (slides("Z", *Z), slides("X", -1, 0, 0)), (0, 0, 100), (-148, 0, 290), Z, factors={"X": 2.0})),
    Machine("citizen-l20", "Citizen Cincom L20", "Swiss type, the bar slides", "mitsubishi", "diameters, Y Z C",
            Bodies((slides("Z", 0, 0, -1), turns("C", down(Z))), (slides("Y", *Y), slides("X", *X)), (0, 0, 0), (110, 0, 0), X,
                   factors={"X": 2.0}), passes.around(Z, X, radius=8, climb=-20), "item 2", tolerance=0.01, length=60),
    Machine("flow-mach500", "Flow Mach 500, Dynamic XD", "water jet, five axes", "isg", "tip, B C",
            mill((), (*HEAD, turns("C", Z), turns("B", Y, (0, 0, 200))), 260, (0, 0, 100)), passes.printed(passes.dome(most=45)),
            tips=True, tolerance=0.02, length=60,
            options=("--spindle", "off")),
    Machine("messer-bevel", "Messer MPC, Skew Rotator", "plasma, bevel head", "linuxcnc", "X Y Z A C",
            mill((), (*HEAD, turns("C", Z), turns("A", X, (0, 0, 30))), 30, (0, 0, 0)), passes.printed(passes.dome(most=45)),
            tolerance=0.05, length=0,
            options=("--spindle", "off")),
    Machine("trumpf-cell3030", "TRUMPF TruLaser Cell 3030", "laser, B C", "siemens", "tip, B C",
            Bodies((), (*HEAD, turns("C", Z), turns("B", Y, (0, 40, 620))), (0, 0, 250), (0, 40, 520)),
            passes.printed(passes.dome(most=80, radius=25)), tips=True, tolerance=0.02, length=50,
            options=("--spindle", "off")),
    Machine("blm-lt7", "BLM LT7", "tube laser, A and B", "siemens", "X Y Z A B",
            mill((slides("X", -1, 0, 0), turns("A", down(X))), (slides("Y", *Y), slides("Z", *Z), turns("B", Y, (0, 0, 380))), 200,
                 (0, 0, 0)), passes.printed(passes.around(X, Z)), tolerance=0.02, length=50,
            options=("--spindle", "off")),
    Machine("gf-cut200", "GF AgieCharmilles CUT 200 mS", "wire EDM, U V", "fanuc", "X Y",
            mill((), (slides("X", *X), slides("Y", *Y), slides("U", *X), slides("V", *Y), slides("Z", *Z)), 0, (0, 0, 0)),
            passes.printed(passes.level()), "not said", "in part", length=0,
            but="no tapers: a CL file that leans the wire is refused, since a chain does not say that U and V lean it",
            options=("--spindle", "off")),
    Machine("zund-g3", "Zund G3 L-2500", "knife, tangential C", "linuxcnc", "X Y Z C",
            mill((), (*HEAD, turns("C", Z)), 50, (0, 0, 0)), passes.outline(), "item 5", tolerance=0.05, lean=0.5, length=20),
    Machine("gmm-tecna", "GMM Tecna 36", "bridge saw, tangential C", "linuxcnc", "X Y Z C",
            Bodies((), (*HEAD, turns("C", Z)), (0, 0, 50), (0, 0, 450), Y), passes.sawn(), "item 5", tolerance=0.1, lean=0.5),
    Machine("mtorres-torresfiberlayup", "MTorres TORRESFIBERLAYUP", "fibre head over a mandrel", "linuxcnc", "X Y Z A B C W",
            mill((turns("A", down(X)),), (*HEAD, turns("C", Z), turns("B", Y, (0, 0, 2000)), turns("W", Z)), 1700, (0, 0, 0)),
            passes.wound(), "item 5", tolerance=0.1, lean=0.5),
    Machine("gfm-us50", "GFM US-50", "ultrasonic knife, C A B", "linuxcnc", "X Y Z A B C",
            mill((), (*HEAD, turns("C", Z), turns("A", X, (0, 0, 780)), turns("B", Z)), 600, (0, 0, 60)), passes.laid(8, 25),
            tolerance=0.05, lean=0.3, length=80),
    Machine("sha-disc", "Sha et al. 2022", "disc cutter, swing length Lm", "siemens", "X Y Z A B C",
            mill((turns("B", down(Y), (0, 0, -400)),), (*HEAD, turns("C", Z), turns("A", X, (0, 0, 1100))), 850, (0, 0, 0)),
            passes.dome(), length=0),
    Machine("liebherr-lc80", "Liebherr LC 80", "gear hobber", "fanuc", "X Y Z A C",
            Bodies((turns("C", down(Z)),), (slides("X", *X), slides("Z", *Z), turns("A", X), slides("Y", *Y)), (0, 0, 0), (180, 0, 0), X),
            passes.gaps(), "not said", "in part", tolerance=0.01,
            but="gaps one by one; hobbing, in which the control turns C with the hob (G81.4), no CL file says"),
    Machine("walter-helitronic", "Walter HELITRONIC POWER", "tool grinder, part A on C", "linuxcnc", "X Y Z A C",
            Bodies((slides("X", -1, 0, 0), turns("C", down(Z)), turns("A", down(X))), (slides("Y", *Y), slides("Z", *Z)), (0, 0, 0),
                   (0, 120, 0), Y), passes.around(X, Y, radius=12, climb=20), "item 12", length=60),
    Machine("voron-24", "Voron 2.4", "printer, core-XY", "klipper", "X Y Z E",
            mill((), (slides("Z", *Z), slides("X", *X), slides("Y", *Y)), 0, (0, 0, 0)), passes.walls(), "item 2",
            tolerance=0.02, length=0, drives=(("A", struts.belt(1)), ("B", struts.belt(-1)))),
    Machine("rotbot", "RotBot (ZHAW)", "printer, leaning nozzle on C", "rrf", "X Y Z C",
            Bodies((), (*HEAD, turns("C", Z)), (0, 0, 0), (0, 0, 0), (0, 1, 1)), passes.cone((0, 1, 1), Z), "item 1",
            tolerance=0.02, lean=0.2, length=0),
    Machine("duet-trunnion", "trunnion printer, plan of 2023", "printer of five axes", "marlin", "X Y Z A C E",
            mill((turns("A", down(X), (0, 0, -30)), turns("C", down(Z))), HEAD, 0, (0, 0, 0)), passes.printed(passes.dome(radius=20)),
            "item 2", tolerance=0.02, lean=0.2, length=0),
    Machine("anycubic-kossel", "Anycubic Kossel Linear Plus", "linear delta", "marlin", "X Y Z E",
            mill((), HEAD, 0, (0, 0, 0)), passes.walls(), "item 9", tolerance=0.02, length=0,
            drives=tuple((name, struts.carriage(angle, 135.4, 271.5)) for name, angle in (("A", 210), ("B", 330), ("C", 90)))),
    Machine("epson-ls6", "Epson LS6-602S", "SCARA", "linuxcnc", "joints A B Z",
            Bodies((), (turns("A", Z), turns("B", Z, (325, 0, 0)), slides("Z", *Z), turns("C", Z, (600, 0, 0))), (420, 80, 50),
                   (600, 0, 250)), passes.flat(), tolerance=0.02, length=60),
    Machine("kuka-kr5arc", "KUKA KR 5 arc", "arm of six axes, poses", "krl", "LIN, A B C of the tool",
            Bodies((), (turns("A", down(Z)), turns("B", Y, (180, 0, 400)), turns("C", Y, (780, 0, 400)), turns("U", down(X), (0, 0, 520)),
                        turns("V", Y, (1400, 0, 520)), turns("W", down(X), (0, 0, 520))), (900, 0, 300), (1515, 0, 440),
                   absolute=True), passes.dome(most=25), "item 7", tolerance=0.05, lean=0.1),
    Machine("abb-irb2400", "ABB IRB 2400/10", "arm of six axes, joints", "rapid", "MoveAbsJ",
            Bodies((), (turns("A", Z), turns("B", Y, (100, 0, 615)), turns("C", Y, (100, 0, 1320)), turns("U", X, (0, 0, 1455)),
                        turns("V", Y, (855, 0, 1455)), turns("W", X, (0, 0, 1455))), (900, 0, 500), (940, 0, 1355), absolute=True),
            passes.dome(most=25), "item 7", tolerance=0.05, lean=0.1),
    Machine("ur10e", "Universal Robots UR10e", "arm of six axes, UR", "urscript", "movej",
            Bodies((), struts.universal(180.7, -612.7, -571.55, 174.15, 119.85), (-600, -300, 0), (-1184.25, -290.7, -29.15),
                   absolute=True), passes.dome(most=25), "item 7", tolerance=0.05, lean=0.1),
    Machine("fanuc-r2000ib", "FANUC R-2000iB/200R", "arm, J3 coupled to J2", "siemens", "joints, J3 - J2",
            Bodies((), (turns("A", Z), turns("B", Y, (720, 0, 600)), turns("C", down(Y), (720, 0, 1675)), turns("U", down(X), (0, 0, 1900)),
                        turns("V", down(Y), (2000, 0, 1900)), turns("W", down(X), (0, 0, 1900))), (1800, 0, 800), (2235, 0, 1780),
                   minus={"C": "B"}, absolute=True), passes.dome(most=25), "item 2", tolerance=0.05, lean=0.1),
    Machine("kuka-kr210-kl", "KUKA KR 210 L150 on KL 1500", "arm on a rail", "krl", "LIN with E1",
            Bodies((), (slides("E1", *Y), turns("A", down(Z)), turns("B", Y, (350, 0, 750), -90.0), turns("C", Y, (350, 0, 2000), 90.0),
                        turns("U", down(X), (0, 0, 1946)), turns("V", Y, (1850, 0, 1946)), turns("W", down(X), (0, 0, 1946))),
                   (1700, 0, 700), (2043, 0, 1826), absolute=True), passes.dome(most=25), "item 7", tolerance=0.05, lean=0.1),
    Machine("abb-irb1600-pos", "ABB IRB 1600 with a positioner", "arm and positioner", "rapid", "MoveAbsJ, eax_a",
            Bodies((turns("X", down(Z), (900, 0, 0)),), (turns("A", Z), turns("B", Y, (150, 0, 486.5)), turns("C", Y, (150, 0, 1186.5)),
                   turns("U", X, (0, 0, 1186.5)), turns("V", Y, (750, 0, 1186.5)), turns("W", X, (0, 0, 1186.5))), (900, 0, 400),
                   (815, 0, 1096.5), absolute=True), passes.dome(most=25), "item 7", tolerance=0.05, lean=0.1),
    Machine("mikrolar-r3000", "hexapod, Mikrolar class", "hexapod", "linuxcnc", "tip, A B",
            mill((), (*HEAD, turns("C", Z), turns("B", Y), turns("A", X)), -60, (0, 0, -1050)), passes.dome(most=18), "item 9",
            tips=True, tolerance=0.01, drives=struts.hexapod(600, 220)),
    Machine("tricept-845", "PKM Tricept T845", "Tricept", "siemens", "tip, A3 B3 C3",
            mill((), (*HEAD, turns("C", Z), turns("A", X)), -190, (0, 0, -1450)), passes.dome(most=30), "item 9", tips=True,
            vectors=True, tolerance=0.02, drives=struts.tricept(450, 130, 160)),
    Machine("exechon-x700", "Exechon X700", "Exechon", "siemens", "tip, A3 B3 C3",
            mill((), (*HEAD, turns("C", Z), turns("A", X)), -180, (0, 0, -1500)), passes.dome(most=30), "item 9", tips=True,
            vectors=True, tolerance=0.02, drives=struts.exechon(400, 350, 200, 150, 220)),
    Machine("ecospeed-f", "Starrag Ecospeed F, Sprint Z3", "portal with a Z3 head", "siemens", "tip, A B",
            mill((), (*HEAD, turns("B", Y), turns("A", X)), -130, (0, 0, -600)), passes.dome(most=25), "item 9", tips=True,
            tolerance=0.01, drives=struts.sprint(200, 300, 600)),
]
