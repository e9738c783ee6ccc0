//! What the codes of messages mean: `error[over-travel]`, `warning[tool-length]`.
//!
//! All that is said to users has a code. A test holds this list against every code in the sources; `post explain` and the
//! book's page of messages are made from it.

/// Codes that come from one part of the work.
pub struct CodeGroup {
    /// What the part is called.
    pub title: &'static str,
    /// Verbs that say them.
    pub verbs: &'static str,
    /// The codes, by their letters.
    pub codes: &'static [Code],
}

/// A code of messages.
pub struct Code {
    /// As it stands in brackets: `over-travel`.
    pub name: &'static str,
    /// What is found.
    pub meaning: &'static str,
    /// What helps.
    pub remedy: &'static str,
}

const fn code(name: &'static str, meaning: &'static str, remedy: &'static str) -> Code {
    Code { name, meaning, remedy }
}

/// All codes. One that two parts say, each in its own sense, is in both groups.
pub const CODES: &[CodeGroup] = &[
    CodeGroup {
        title: "Command line, files and plugins",
        verbs: "all verbs",
        codes: &[
            code(
                "input",
                "A file cannot be read, or two inputs would both be standard input.",
                "Check name and rights; name one of the two as a file.",
            ),
            code(
                "lsp",
                "The editor's connection broke, or what came over it is no message.",
                "Start `post lsp` from the editor, not by hand.",
            ),
            code(
                "machine",
                "There is no machine of that name, or its file cannot be read.",
                "`post machines` lists the names; a file is named with its ending .toml.",
            ),
            code(
                "output",
                "A file cannot be written, or the run would write over a file that it reads, or a folder holds files that are not its own.",
                "Another target, or the rights that the message names. Nothing was replaced.",
            ),
            code(
                "plugin",
                "A plugin cannot be opened or trusted, is not there, or did what its contract forbids.",
                "`post plugin list` says what is found and where; `post plugin test` what is wrong with one of your own.",
            ),
            code(
                "plugin-test",
                "The arguments of `post plugin test` do not fit the plugin.",
                "An option is KEY=VALUE; `post plugin show` lists them.",
            ),
            code(
                "setting",
                "`--set` names no parameter and no key, or gives no value.",
                "Write `--set NAME=VALUE`; `post schema` and the reference of keys have the names.",
            ),
            code(
                "solid",
                "A file that `[solids]` of the machine file names cannot be shown; what follows from the chain is drawn instead.",
                "An STL file, binary or text, in mm; its path is that from the machine file. Programs do not depend on it.",
            ),
            code(
                "syntax",
                "A line of the CL file cannot be read.",
                "The marked place is where reading stopped. Let the CAM system write the file again, or correct the line.",
            ),
            code(
                "view",
                "The report was written, and could not be opened.",
                "Open the file that the message names in a browser.",
            ),
            code(
                "words",
                "More different words that post does not know than a CL file has.",
                "Is this a cutter-location file?",
            ),
        ],
    },
    CodeGroup {
        title: "The machine file",
        verbs: "all verbs that take a machine, post lsp",
        codes: &[
            code(
                "check",
                "Nothing is wrong with the file as such, but something looks wrong: an upright tool out of reach, the part origin out of travel, an axis without `max_feed`; or there is no such head.",
                "Compare with the machine, then correct the file.",
            ),
            code(
                "check-nominal",
                "The measured and the nominal machine cannot be compared: their axes differ, or one cannot be brought to the part origin.",
                "Both files need the same axes in the same order; derive the measured one by `extends`.",
            ),
            code(
                "machine-accuracy",
                "A bound of `[accuracy]` is out of its range.",
                "The message gives the range.",
            ),
            code(
                "machine-arcs",
                "`[control] arcs` asks for what cannot be.",
                "The message says what goes together.",
            ),
            code(
                "machine-axis",
                "An axis of the chain has no table, a table no axis, or an axis is neither linear nor rotary, or lacks its line.",
                "One `[axis.X]` for each letter of the chain, `rotary` with `point`, `linear` without.",
            ),
            code(
                "machine-chain",
                "The chain cannot be read, misses part or tool, names an axis on the wrong side of the bed, or cannot be solved.",
                "`[w C' A' b Y X Z (S) t]`: axes that carry the part have a prime and stand left of `b`.",
            ),
            code(
                "machine-control-point",
                "The point of the tool that is guided is described impossibly.",
                "Lengths from 0 up, mm.",
            ),
            code("machine-corner", "`corner` is no angle from 0 to 180 degrees.", "10 is usual."),
            code(
                "machine-depth",
                "The axis that the control's length compensation acts along would take a longer tool into the part.",
                "Turn the sign of that axis, or say which axis is the depth.",
            ),
            code(
                "machine-direction",
                "A direction has no length, or the leading edge does not stand across the tool axis.",
                "Three numbers, not all zero.",
            ),
            code(
                "machine-edge",
                "The tool has a leading edge, and the machine lacks the axis to turn it.",
                "Three rotary axes, or no `[tool] edge`.",
            ),
            code(
                "machine-expression",
                "An expression cannot be evaluated: a name is not known, or two parameters need each other.",
                "Names stand in `[parameters]`; near ones are proposed.",
            ),
            code(
                "machine-extends",
                "The file that `extends` names is not there, is no machine file, or extends itself.",
                "A built-in name, or a path from the file's own folder.",
            ),
            code(
                "machine-feed",
                "Rapids shall be written as moves at feed, and an axis says no largest feed.",
                "`max_feed` of that axis.",
            ),
            code(
                "machine-frame",
                "`retract`, `leave` or `park` names an axis that is not there or does not lead the tool off.",
                "Linear axes for a retract and first in `leave`, any axis to park.",
            ),
            code(
                "machine-head",
                "A `[head.NAME]` changes what a head cannot change.",
                "Axes, their order and the part are the machine's; lines, tool and limits may be the head's.",
            ),
            code(
                "machine-key",
                "A key that machine files do not have, or a value of another kind.",
                "Near keys are proposed; `post schema` has all.",
            ),
            code(
                "machine-motion",
                "A value of `[motion]` is out of its range.",
                "The message gives the range and unit.",
            ),
            code(
                "machine-number",
                "A number is missing, not finite or too large.",
                "Lengths are up to 10 km, mm.",
            ),
            code(
                "machine-option",
                "An option of a dialect or model has a value of another kind, or a table names no dialect.",
                "`post plugin show NAME` lists options and what they take.",
            ),
            code(
                "machine-plan",
                "A value of `[plan]` is out of its range.",
                "The message gives the range and unit.",
            ),
            code(
                "machine-points",
                "`points` of compensation is out of its range.",
                "Leave it out: the peak then decides.",
            ),
            code(
                "machine-program",
                "A value of `[program]` cannot be.",
                "The message says what it takes.",
            ),
            code(
                "machine-rewind",
                "`[rewind]` does not say how far the tool is drawn back.",
                "`distance`, mm.",
            ),
            code(
                "machine-servo",
                "`[servo.X]` is incomplete, contradicts itself, or does not fit the axis.",
                "One description a servo: `loops`, `transfer` or `pid`.",
            ),
            code(
                "machine-size",
                "The file has more entries than a machine has.",
                "Is this a machine file?",
            ),
            code(
                "machine-solution",
                "A rule of `[solution]` names no axis, or one that it cannot be of.",
                "The message lists the rules and axes.",
            ),
            code(
                "machine-solid",
                "`[solids]` names what the machine has no axis for, or what is no STL file.",
                "A letter of the chain with a file that ends in `.stl`.",
            ),
            code(
                "machine-spindle",
                "The speeds of `[spindle]` are not above zero, or the wrong way round.",
                "`min_speed` below `max_speed`, 1/min.",
            ),
            code(
                "machine-syntax",
                "The file is no TOML.",
                "The marked place is where reading stopped.",
            ),
            code(
                "machine-tcp",
                "The file does not say who keeps the tip on its path, or `tcp = \"control\"` does not fit its axes.",
                "`tcp = \"control\"` or `tcp = \"post\"` in `[control]`.",
            ),
            code(
                "machine-text",
                "A text holds a line end or a sign that cannot be seen.",
                "Several lines are a list of texts.",
            ),
            code("machine-tolerance", "A tolerance is not above zero.", "mm and degrees."),
            code(
                "machine-tools",
                "`[tools]` has a length below zero or no tool number.",
                "`3 = 118.5`, mm.",
            ),
            code(
                "machine-travel",
                "Travel is missing, the wrong way round, too many turns, or stands beside `cyclic`.",
                "`travel = [least, most]`, or `cyclic = true`.",
            ),
            code(
                "machine-word",
                "A rule of `[cl.words]` writes nothing, or is for a word that has a meaning to post.",
                "`AUXFUN = \"M{n}\"`; leave out words that post carries out.",
            ),
            code(
                "program-text",
                "A line of `[program]` cannot be written: a field is not known or has no value here.",
                "The facts that a line can speak of are in the reference of keys.",
            ),
        ],
    },
    CodeGroup {
        title: "Reading a CL file",
        verbs: "post, place, convert, --verify, post lsp",
        codes: &[
            code(
                "after-fini",
                "Records stand behind `FINI`; they are left out.",
                "Is it one file?",
            ),
            code(
                "allowed-word",
                "A word was left out because `--allow` says so, or `--allow` names a word that the file does not have.",
                "Nothing; see to what the word asked for.",
            ),
            code(
                "arc",
                "An arc has no end, no beginning, or numbers that are no circle.",
                "Let the CAM system write lines, or correct the record.",
            ),
            code(
                "axis",
                "A tool axis or the direction of an edge is null or not known.",
                "i, j, k point from the tip to the holder.",
            ),
            code(
                "compensation",
                "Cutter radius compensation stands where no control could do the same.",
                "Compensate in the CAM system; or in the plane of X and Y with an upright tool.",
            ),
            code(
                "coordinate",
                "A coordinate is larger than any machine.",
                "Check the units and the record.",
            ),
            code(
                "cut-off",
                "The file has no end: `FINI` is missing, or the last line breaks off.",
                "Write the file again; `--allow FINI` takes it to be whole.",
            ),
            code(
                "cutter",
                "A cutter is described impossibly, or a second one without a tool change.",
                "`--tool-from-cutter` numbers tools by their cutters.",
            ),
            code(
                "cycle",
                "A cycle is not known, incomplete, or not one that this control does the same way.",
                "Another cycle in the CAM system, or `[control] cycles = \"moves\"`.",
            ),
            code(
                "dwell",
                "A wait is negative, too long, or in turns of a spindle that stands.",
                "Seconds, up to a day.",
            ),
            code("empty", "The file has no move.", "Is it the right file?"),
            code(
                "feed",
                "A feed is not above zero, or in a unit that cannot be.",
                "`FEDRAT/v,MMPM` or `MMPR`.",
            ),
            code(
                "godlta",
                "A step from the last point, and there is none, or a cycle is on.",
                "`GOTO` in its place.",
            ),
            code(
                "insert",
                "An `INSERT` holds a code of the control, and would be written as a remark.",
                "`--set control.insert=literal` writes it as a line; `--allow INSERT` as a remark.",
            ),
            code(
                "mcs",
                "`MCS` is a frame of its own, and nobody here knows whether points are meant in it.",
                "Tool axes with the points (`MULTAX/ON`), in the frame of the part.",
            ),
            code(
                "msys",
                "The axes of `MSYS` are no frame.",
                "Without `--msys apply` it is not needed.",
            ),
            code("no-feed", "A move has no feed.", "`--feed 800` gives one, mm/min."),
            code(
                "refused-word",
                "A word changes where or whether metal is cut, and post does not know how.",
                "Its lines in `[cl.words]` of the machine file, or `--allow WORD`, which leaves it out: but for a word that moves the tool.",
            ),
            code(
                "rotabl",
                "Index angles contradict the tool axis, or say no axis.",
                "One of the two in the CAM system.",
            ),
            code(
                "spindle",
                "The spindle has no speed, stands in a cut, or was switched on again after a tool change.",
                "`--spindle 6000`; `--spindle off` for a tool that does not turn.",
            ),
            code(
                "spindle-speed",
                "The speed is outside of `[spindle]`, or a cutting speed has no limit.",
                "Another speed in the CAM system, or the limit of the machine file.",
            ),
            code(
                "spline",
                "A spline has no end or beginning, too many points, or tool axes.",
                "Let the CAM system write lines.",
            ),
            code(
                "split",
                "The file has nothing to be split by, or `--split` goes to standard output.",
                "A file name for `-o`.",
            ),
            code(
                "tool",
                "A tool has no number, no size that can be, or is numbered twice.",
                "`--tool 3`, or `--tool-from-cutter`.",
            ),
            code(
                "tool-length",
                "The length of the tool is not known. A warning where it only bounds travel, an error where a head turns and the post keeps the tip.",
                "`--tool-length 120`, or `[tools]` in the machine file.",
            ),
            code(
                "units",
                "The file says no units, or says them too late.",
                "`--units mm` or `--units inch`.",
            ),
            code(
                "unknown-path",
                "A word that post does not know stands between moves with three numbers or more: it may be a move itself, and is never left out.",
                "GOTO and CIRCLE from the CAM system, or its lines in `[cl.words]` of the machine file.",
            ),
            code(
                "unknown-word",
                "A word that post does not know.",
                "`--allow WORD` for one; `--unknown error`, `known`, `warn` or `pass` for all; `post words part.cls` lists them.",
            ),
            code(
                "word-rule",
                "A rule of `[cl.words]` does not fit the record.",
                "The message says which number is missing or left over.",
            ),
            code(
                "words",
                "More different unknown words than a CL file has.",
                "Is this a cutter-location file?",
            ),
            code(
                "work-offset",
                "A work offset that the dialect does not have, or that holds for one mount alone.",
                "1 is G54; with rotary axes in the table one offset, or `tcp = \"control\"`.",
            ),
        ],
    },
    CodeGroup {
        title: "Making the program",
        verbs: "post, place, convert",
        codes: &[
            code(
                "dialect",
                "The dialect cannot write what is asked for, or lines that the machine file gives are not used by it.",
                "`post plugin show NAME` says what it writes; the help names the lines of your own.",
            ),
            code(
                "edge",
                "A leading edge cannot be turned here.",
                "`[rewind]` and `[solution] edge` say how.",
            ),
            code(
                "exclusive",
                "A cut moves axes at once that the machine moves one at a time.",
                "Another strategy in the CAM system, or `[solution] exclusive`.",
            ),
            code(
                "feed-mode",
                "`[control]` asks for inverse time feeds, and the dialect has none.",
                "Another `feed`, or another dialect.",
            ),
            code(
                "head",
                "The file swaps in a head that the machine file does not have.",
                "`[head.NAME]`.",
            ),
            code(
                "index",
                "Index axes have no position that carries the pass.",
                "Another tool axis in the CAM system, or the positions of the axis.",
            ),
            code(
                "jump",
                "A cut cannot go on: the axes would have to jump to another solution within tolerance.",
                "`[rewind]`, another mount (`post place`), or a cut that ends here.",
            ),
            code(
                "length-axis",
                "The words are axis positions, and the control puts the length of the tool along another axis than the one along which the tool lies; or it puts none on, and the work offset is measured with the tool in the spindle.",
                "`[tool] length_axis`, where the control can be told; `\"none\"` with the length 0 in the control and a work offset measured with the tool; or `tcp = \"control\"`.",
            ),
            code(
                "kinematics",
                "A solution put back through the chain misses its point: a fault of the file or of post.",
                "`post check` has a round trip; please report it.",
            ),
            code(
                "low-feed",
                "A feed is below the least that is printed; it is raised, or refused if an axis would be too fast.",
                "A higher `FEDRAT`, or more decimals for feeds.",
            ),
            code("model", "The error model cannot answer.", "Another `[accuracy] model`."),
            code("more", "More warnings than are told one by one.", "Put right those above first."),
            code(
                "out-of-reach",
                "The machine cannot point the tool this way, or cannot bring the tip there.",
                "Another tool axis, `axis_tolerance`, or another machine; `post check --svg` draws the reach.",
            ),
            code(
                "over-travel",
                "An axis would pass the end of its travel, in a block or between its words.",
                "`--mount`, found by `post place`; a shorter tool; or the travel of the machine file if it is wrong.",
            ),
            code(
                "plane",
                "In a tilted plane the axes would have to change solution within a cut.",
                "`[control] planes = false`, or another plane.",
            ),
            code(
                "planes",
                "Tilted planes are asked for, and the dialect writes none here.",
                "Nothing if the program is good without.",
            ),
            code(
                "register",
                "The file asks for a length register that this control does not know.",
                "Nothing if the control's own table has the length.",
            ),
            code(
                "retract",
                "The tool cannot be led off the part by what the machine file says.",
                "`[control] retract` or `leave`, or `tcp = \"control\"`.",
            ),
            code(
                "rounding",
                "The decimals of the dialect alone pass the tolerance.",
                "More decimals, or a larger tolerance.",
            ),
            code(
                "subprogram",
                "What a subprogram does is not checked.",
                "Nothing; the tool comes near anew behind it.",
            ),
            code(
                "tolerance",
                "A tolerance is below what the printed words can keep.",
                "A larger one, or more decimals.",
            ),
            code(
                "unwinding",
                "At the end a rotary axis has turns to take back.",
                "Nothing, or another `[control] park`.",
            ),
        ],
    },
    CodeGroup {
        title: "Placing, planning and compensating",
        verbs: "post new, place, --plan, --compensate-servo",
        codes: &[
            code(
                "compensate-servo",
                "Compensation lacks its bound or the servos.",
                "`[accuracy] servo_compensation` and `[servo.X]`.",
            ),
            code(
                "new",
                "`post new` would replace a file, or a flag says what the machine does not have.",
                "`--force`, or another flag.",
            ),
            code(
                "place",
                "No mount lets the part fit, or none is searched for on this machine.",
                "The message says by how much travel is short; `--search-turn`, a smaller `--margin`.",
            ),
            code(
                "plan",
                "Nothing is planned, or a limit has nothing to act on.",
                "`max_accel` and `[servo.X]` in the machine file.",
            ),
            code(
                "plan-rounds",
                "Rounds have no limit to keep, or no servos to predict with.",
                "`[plan] contour_error` and `[servo.X]`.",
            ),
        ],
    },
    CodeGroup {
        title: "Comparing with the papers",
        verbs: "papers study, papers plan",
        codes: &[
            code("curve", "A curve file cannot be read.", "`papers plan --help` lists its keys."),
            code(
                "infeasible",
                "No feed keeps the limits at one place of the curve.",
                "The message says where, and which limits.",
            ),
            code(
                "study",
                "A study has nothing to look at: no such move, a file without cuts, a value of `--sweep` that cannot be.",
                "The message says which.",
            ),
        ],
    },
    CodeGroup {
        title: "Reading a program back",
        verbs: "post read, verify, diff, convert, predict, --verify, --predict",
        codes: &[
            code(
                "convert",
                "Something of the program is not carried over to the other machine.",
                "See to it by hand in the new program.",
            ),
            code(
                "course",
                "A record of the CL file is not one that a program can be held against.",
                "The message says what it would need.",
            ),
            code(
                "nc-arc",
                "An arc is not one circle: no centre, both centre and radius, or ends that differ.",
                "Its words, or `--offsets` if a radius stands there.",
            ),
            code(
                "nc-axis",
                "A word names no axis of the machine.",
                "Is it the right machine file?",
            ),
            code(
                "nc-conversational",
                "A Klartext word that is not run: what the machine does then is not followed.",
                "Take it out for the check, or check that part at the machine.",
            ),
            code("nc-cycle", "A cycle is not known here or incomplete.", "Moves in its place."),
            code(
                "nc-dwell",
                "A wait says no time that is known.",
                "G4 with X, P, F or S as the control has it.",
            ),
            code(
                "nc-expression",
                "An expression cannot be evaluated, or means another thing on each control.",
                "Write the number.",
            ),
            code("nc-feed", "A feed is missing or no feed.", "F in the block, or before it."),
            code(
                "nc-file",
                "The program cannot be read again from its beginning.",
                "A file in the place of a pipe.",
            ),
            code(
                "nc-flow",
                "A jump or loop leads out of what is read.",
                "The whole program in one file.",
            ),
            code(
                "nc-frame",
                "A shift, turn or mirror of the frame that is not run.",
                "G52, G54 to G59 and tilted planes are.",
            ),
            code(
                "nc-length",
                "A tool's length is not known, or acts along another axis.",
                "`--tool-length`, `[tools]` or `--offsets`.",
            ),
            code("nc-limit", "More blocks, loops or holes than are run.", "`--most-blocks`."),
            code(
                "nc-machine",
                "Machine coordinates are used in a way that is not settled.",
                "G53 with G90 on a straight line.",
            ),
            code(
                "nc-motion",
                "Words of axes, and no word says how they move.",
                "G0 or G1 before them.",
            ),
            code(
                "nc-number",
                "Axis words without a decimal point may be least increments by a parameter of the control.",
                "Compare one with the machine.",
            ),
            code(
                "nc-plane",
                "A tilted plane is begun, turned to or left in a way that is not run.",
                "Turn the axes to the plane first; end one before the next.",
            ),
            code("nc-probe", "A probing move ends where it touches.", "Take it out for the check."),
            code(
                "nc-reach",
                "The axes cannot bring the tip where the program wants it.",
                "Is it the right machine file, with this tool length and these offsets?",
            ),
            code(
                "nc-reference",
                "A way over a reference position that nobody told.",
                "`[reference.1]` in the file of `--offsets`.",
            ),
            code(
                "nc-refused",
                "So many blocks were refused that reading stopped.",
                "Put right those above first.",
            ),
            code(
                "nc-skip",
                "Blocks behind `/` are run, as with the operator's switch off.",
                "Nothing.",
            ),
            code(
                "nc-spline",
                "Control points, knots or weights that make no spline, or in a way that is not run.",
                "Let the post-processor write moves: the option `splines` of the dialect.",
            ),
            code(
                "nc-subprogram",
                "A subprogram is called that does not stand in this file.",
                "Put it behind the program.",
            ),
            code("nc-thread", "A thread says no pitch.", "F or K as the control has it."),
            code(
                "nc-tool",
                "A tool call is not one that is known here.",
                "A number, tool axis Z, outside of planes and TCP.",
            ),
            code(
                "nc-unknown",
                "A word nobody knows; it is taken to move nothing.",
                "See that it does not.",
            ),
            code(
                "nc-variable",
                "A variable belongs to the control, or was never set.",
                "Set it in a block in front.",
            ),
            code(
                "nc-vector",
                "A tool vector has no length, or the axes cannot point there.",
                "Is it the right machine file?",
            ),
            code(
                "nc-word",
                "A word may change what the others mean, or where the machine goes.",
                "Take it out for the check, or tell the dialect's vocabulary.",
            ),
            code(
                "nc-work-offset",
                "A work offset that nobody told.",
                "`[work.G54]` in the file of `--offsets`; otherwise it is that of `mount`.",
            ),
            code(
                "offsets",
                "The file of offsets cannot be read.",
                "`post read --help` shows its form.",
            ),
            code("read", "Reading the CL file broke off.", "The message has the system's reason."),
            code(
                "turned-part",
                "The part sits turned on the machine, and a CL file of the motions would be turned once more when it is posted.",
                "`--set workpiece.turn=0`.",
            ),
            code(
                "vocabulary",
                "The dialect tells no words, so that its programs cannot be read back.",
                "A dialect of your own tells them by `vocabulary`.",
            ),
        ],
    },
    CodeGroup {
        title: "Holding a program against its CL file",
        verbs: "post verify, convert, --verify",
        codes: &[
            code(
                "added",
                "A motion at feed that the CL file does not ask for.",
                "Look at both lines.",
            ),
            code(
                "compensation",
                "Radius compensation is another than the CL file asks for.",
                "Look at both lines.",
            ),
            code(
                "coolant",
                "Coolant is another in a cut, or flows while the tool is changed.",
                "Look at both lines; `--ignore coolant` where coolants are yours.",
            ),
            code(
                "deviation",
                "The program leaves the path by more than the tolerance.",
                "The line of the CL file is told; `--plan` and servo compensation have tolerances of their own.",
            ),
            code(
                "event",
                "A stop, wait, offset or subprogram is left out, added or in another place.",
                "Look at both lines.",
            ),
            code(
                "feed",
                "A cut has no feed, or is faster or slower than the CL file asks for.",
                "`--planned` for programs whose feed was planned.",
            ),
            code("hole", "A hole is of another kind, depth or way in.", "Look at both lines."),
            code(
                "length",
                "Length compensation is in force with another length than the tool's.",
                "`--tool-length`, `[tools]`.",
            ),
            code(
                "missing",
                "A motion that the CL file asks for is not there.",
                "Look at both lines.",
            ),
            code(
                "over-travel",
                "The program leads an axis past its travel.",
                "The mount with which it was posted: `--mount`, `--offsets`.",
            ),
            code(
                "rapid",
                "A rapid comes nearer to what is cut than the CL file allows, or ends in it; leaves the way of the CL file's; leads where neither the CL file nor the machine file sends the axis; or is made at feed.",
                "Look at the way at the machine before it runs. `[control] retract`, `change` and `park` name places of the machine, `rapid = \"linear\"` lets rapids be feed moves as fast as the axes go.",
            ),
            code("register", "Another length or radius register, or none.", "Look at both lines."),
            code(
                "smoothing",
                "The control may leave the path by more than the tolerance and than `[program.smoothing]`.",
                "A tolerance of the CL file's accuracy, or `--tolerance` as large as what is meant.",
            ),
            code(
                "spindle",
                "The spindle stands, turns otherwise, or turns while the tool is changed.",
                "Look at both lines.",
            ),
            code("tool", "Another tool.", "Look at both lines."),
            code("work-offset", "Another work offset.", "Look at both lines."),
        ],
    },
    CodeGroup {
        title: "Predicting",
        verbs: "post predict, --predict",
        codes: &[
            code(
                "contour-far",
                "The tool strays so far from the CL file that it is hardly that of this program.",
                "The CL file, tool length, mount and units of the program; `post verify` says where they part.",
            ),
            code(
                "fit",
                "`--fit` has too little to go by, or leads to servos that cannot be.",
                "A longer log, fewer numbers, or nearer ones to begin with.",
            ),
            code(
                "head",
                "The program swaps heads: other axes move from here on.",
                "Predict the programs of its heads one by one (`--split tools`).",
            ),
            code(
                "log",
                "The log does not lie over the program, or at two times, or has rows that cannot be read.",
                "Is it of this program, with this tool length, mount and offsets?",
            ),
            code(
                "log-columns",
                "A column of the log is not known, or two hold the same.",
                "`--columns \"t=time,X=cmd_x,X'=act_x\"`.",
            ),
            code(
                "log-zeros",
                "`--log-zeros` names an axis that is not there.",
                "An axis of the machine.",
            ),
            code(
                "motion-assumed",
                "Something takes time that is not known, and none is counted.",
                "`[motion]` has times of stops, tool changes and the spindle.",
            ),
            code(
                "motion-limits",
                "Axes without a limit are taken to reach any speed at once.",
                "`max_feed`, `max_accel`, `max_jerk` of the axis.",
            ),
            code(
                "motion-unreachable",
                "A block cannot be run by the axes.",
                "Tool lengths and work offsets may be others: `--tool-length`, `--offsets`, `--mount`.",
            ),
            code("no-motion", "The program moves nothing.", "Is it the right file?"),
            code("period", "The period of set-points cannot be.", "`--period`, seconds."),
            code(
                "servo",
                "The equations of a servo are out of all proportion.",
                "Its numbers in the units of the machine file.",
            ),
        ],
    },
    CodeGroup {
        title: "Many jobs",
        verbs: "post batch, the Python package",
        codes: &[
            code(
                "batch",
                "There is no job to do, more of them than a run takes, or a worker cannot be started.",
                "CL files, or a list of jobs that ends in .jsonl; several runs, or fewer `--jobs`.",
            ),
            code(
                "job",
                "A line of the list of jobs, or a setting of a job, cannot be read.",
                "`{\"file\": \"part.cls\", \"machine\": \"dmu50\"}`; the message names the line.",
            ),
            code(
                "journal",
                "There is no file beside which a journal could be.",
                "Name it: `--resume=FILE`.",
            ),
            code(
                "map",
                "The picture is to show a column that the table does not have.",
                "The message lists the columns.",
            ),
            code(
                "panic",
                "post itself failed at this job; the others are done.",
                "Please report it, with the job's row.",
            ),
        ],
    },
    CodeGroup {
        title: "Calls from Python",
        verbs: "PostError of the Python package",
        codes: &[
            code(
                "edge",
                "A leading edge is asked for by a path, and has no direction at each point.",
                "As many directions as points, of three numbers.",
            ),
            code(
                "option",
                "An argument is not one that the command has, or takes another value.",
                "`post --help` lists what the keywords stand for.",
            ),
            code(
                "point",
                "A point or direction of the path has numbers that are not finite, or no length.",
                "Millimetres, and directions from the tip to the holder.",
            ),
            code(
                "unreachable",
                "At a point of the path the linear axes cannot bring the tip there.",
                "`Machine.inverse` says how many solutions a point has.",
            ),
        ],
    },
];
