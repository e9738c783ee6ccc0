/* The plugin contract of `post` for C and C++: write a control's language or an error model.
 *
 * A library `libpost_<name>.so` (`.dylib`; `post_<name>.dll`) exports one constant, `post_plugin_<name>`:
 *
 *     POST_EXPORT const PostPlugin post_plugin_minimal = {
 *         POST_HEAD(POST_KIND_DIALECT, PostDialect), ...
 *     };
 *
 * Rules
 * - Whoever made a thing frees it. Pointers that come with a call are valid until it returns.
 * - Text is UTF-8 with a length, without a terminating zero.
 * - A context is used from one thread at a time, though not always the same; several may be open at once,
 *   so keep no state outside of it. A library is never unloaded.
 * - Numbers that come in are finite. Numbers that go out must be.
 * - An event of a kind or code that you do not know must be refused, never dropped.
 * - No C++ exception and no longjmp may leave a function.
 *
 * This header is for 64-bit machines; the assertions of post_plugin_tables.h say so if it is not one. That file has the
 * meanings of words too, for the vocabulary of a dialect; it is included at the end.
 * The blocks between the marks of both files are written by `UPDATE_HEADER=1 cargo test -p post-plugin --test it header`.
 */
#ifndef POST_PLUGIN_H
#define POST_PLUGIN_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
#define POST_LANGUAGE extern "C"
#else
#define POST_LANGUAGE extern
#endif
#ifdef _WIN32
#define POST_VISIBLE __declspec(dllexport)
#else
#define POST_VISIBLE __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    const uint8_t *ptr;
    size_t len;
} PostText;

/* Takes text from a plugin: call `write(ctx, ptr, len)` as often as liked, until the call that brought the
 * sink returns. */
typedef struct {
    void *ctx;
    void (*write)(void *ctx, const uint8_t *ptr, size_t len);
} PostSink;

/* `kind` is POST_OPTION_FLAG (`integer` is 0 or 1), _INTEGER, _NUMBER or _TEXT (also for a choice, and
 * for lines, with line feeds between). */
typedef struct {
    uint32_t kind;
    uint32_t reserved;
    int64_t integer;
    double number;
    PostText text;
} PostValue;

typedef struct {
    PostText key;
    PostValue value;
} PostPair;

/* An option that the plugin accepts in the machine file. `min`, `max`: of an integer or a number, both
 * allowed. `default_value` must fit. */
typedef struct {
    PostText key;
    PostText help;
    uint32_t kind;
    uint32_t reserved;
    double min;
    double max;
    PostValue default_value;
    const PostText *choices;
    size_t choices_len;
} PostOption;

/* `rotary`: 1 for degrees, 2 if its words also lie within one turn, so that the control must take the shorter way,
 * 3 if its word is a place within one turn and by its sign the way there, under POST_WRITES_SIGN_IS_WAY.
 * `depth`: the linear axis along the spindle at all axes zero. `carries_part`: else it carries the tool. `least`,
 * `largest`: position of the axis as the machine shows it, mm or degrees; NaN without ends. */
typedef struct {
    PostText name;
    uint32_t rotary;
    uint32_t depth;
    uint32_t carries_part;
    uint32_t reserved;
    double least;
    double largest;
} PostAxisWord;

/* mm; NaN is not known. */
typedef struct {
    PostText name;
    uint32_t number;
    uint32_t reserved;
    double length; /* from the gauge point to the tip */
    double diameter;
    double corner_radius;
} PostTool;

/* Later versions may append to it: read no further than `size`. */
typedef struct {
    uint64_t size;
    PostText program;
    PostText machine;
    uint32_t units; /* POST_UNITS_ */
    uint32_t tcp;   /* 1 if the control keeps the tip on its path */
    const PostAxisWord *words;
    size_t words_len;
    const PostPair *options; /* every declared one has a value */
    size_t options_len;
    PostText cl_file;
    double tip_tolerance;  /* of a cut, mm; 0 where nothing is certified */
    double axis_tolerance; /* degrees */
    double rapid_tolerance;
    uint32_t ahead; /* 1 if the host has looked ahead, so that what follows is known */
    uint32_t moves; /* 1 if `least` and `largest` are known */
    const PostTool *tools; /* in the order in which they are first used */
    size_t tools_len;
    double least[3]; /* of the tip, mm, part frame */
    double largest[3];
    double time; /* seconds; NaN is not known */
    uint32_t turns_part; /* 1 if the spindle turns the part: a lathe */
    uint32_t diameters; /* words that are twice the position of their axis: a bit by their place in `words` */
} PostSetup;

/* One step of a program. What its numbers and texts are stands below at POST_EVENT_ of its kind; POST_AT_LINEAR_FEED
 * is the place of the feed among the numbers of a POST_EVENT_LINEAR: post_number() and the like read them. A feed is two numbers, POST_FEED_ and its
 * value; a tool six, tip in mm and unit vector from the tip to the spindle, both in the part frame. NaN is not
 * given. Axis words are as many as the setup has, rounded to the decimals of the format. Later versions may put
 * more numbers and texts behind those that you know. `line` is that of the CL file. */
typedef struct {
    uint32_t kind;
    uint32_t texts_len;
    uint64_t line;
    const double *numbers;
    size_t numbers_len;
    const PostText *texts;
} PostEvent;

/* Comes filled with zeros but for `size`: write no further. Decimals are at most 9; `inverse_time` is -1 if there
 * is no G93; `words_len` is that of the setup; `extension` is padded with zeros; `writes` is the sum of
 * POST_WRITES_ of all that the dialect writes beyond straight moves: 0 to begin with. `most_inverse_time` is the
 * largest F under G93, 0 if it has no end. `plane_angles` is POST_PLANE_: how the control is told a tilted plane,
 * with `plane_decimals`. `language` is POST_LANGUAGE_: what programs are read back by, 0 (MACRO) if you do not say.
 * `rapid_feed` is the feed of rapids where G0 goes at F, program units a minute, 0 if it goes as fast as the axes can. */
typedef struct {
    uint64_t size;
    uint8_t words[32];
    uint32_t feed;
    int32_t inverse_time;
    uint32_t feed_per_revolution;
    uint32_t words_len;
    uint8_t extension[16];
    uint64_t writes;
    double most_inverse_time;
    uint32_t plane_angles;
    uint32_t plane_decimals;
    uint32_t language;
    uint32_t reserved; /* 0 */
    double rapid_feed;
} PostFormat;

/* tip: mm, part frame, minus the chord. axis: rotation vector in degrees, part frame. */
typedef struct {
    double tip[3];
    double axis[3];
} PostDeviation;

typedef struct {
    double tip;  /* mm */
    double axis; /* degrees */
} PostTolerance;

/* Largest deviations and where (0 to 1); `terms` are the model's own. */
typedef struct {
    double tip_peak;
    double tip_at;
    double axis_peak;
    double axis_at;
    double terms[60];
} PostCurve;

typedef void (*PostEmit)(void *host, const PostOption *option);
typedef void (*PostEmitWord)(void *host, uint32_t meaning, const uint8_t *word, size_t len);
typedef void (*PostDeviationFn)(void *host, size_t n, const double *ts, PostDeviation *out);

/* The functions of a dialect; none up to `close` may be null. */
typedef struct {
    /* Once a program. The context, or null after a sentence to `error`. */
    void *(*open)(const PostSetup *setup, const PostSink *error);
    /* Once after `open`. 0, else the reason is in `last_error`. */
    int32_t (*format)(void *ctx, PostFormat *format);
    /* Text of `n` events in order to `out`, whole lines each; `ends[i]`: bytes written in this call up to
     * the end of event `i`. Returns the number of events written; if less than `n`, the next one failed
     * and the reason is in `last_error`. */
    size_t (*write)(void *ctx, const PostEvent *events, size_t n, const PostSink *out, uint64_t *ends);
    void (*last_error)(void *ctx, const PostSink *out);
    /* Once, at the end, also after a failure. */
    void (*close)(void *ctx);
    /* Calls `emit(host, POST_MEANING_..., word, len)` for each word of the control, so that programs can be read
     * back. At most once, after `format`. 0, else the reason is in `last_error`. May be null. */
    int32_t (*vocabulary)(void *ctx, void *host, PostEmitWord emit);
    /* What its programs rely on at the control (parameters, options), one sentence a line to `out`, for the setup
     * sheet. At most once, after `format`. 0, else the reason is in `last_error`. May be null. */
    int32_t (*relies_on)(void *ctx, const PostSink *out);
} PostDialect;

/* The functions of an error model; none may be null. */
typedef struct {
    /* Once a program and thread. */
    void *(*open)(const PostPair *options, size_t n, const PostSink *error);
    /* `deviation(host, n, ts, out)` may be called inside this call and from this thread. 0, or a failure. */
    int32_t (*fit)(void *ctx, const PostTolerance *tolerance, PostDeviationFn deviation, void *host,
                   PostCurve *curve);
    /* The fitted deviation at `n` places. 0, or a failure. */
    int32_t (*value)(void *ctx, const PostCurve *curve, size_t n, const double *ts, PostDeviation *out);
    void (*last_error)(void *ctx, const PostSink *out);
    void (*close)(void *ctx);
} PostModel;

/* What a library exports. The fields up to `layout` never move; the host reads them before all else. */
typedef struct {
    uint64_t magic;
    uint32_t abi;
    uint32_t kind;
    uint32_t size;
    uint32_t table_size;
    uint64_t layout;
    PostText name; /* as in the symbol */
    PostText version;
    /* Calls `emit(host, &option)` for each option. Null: none. Once, at opening. */
    void (*describe)(void *host, PostEmit emit);
    /* Once after opening; may be null. */
    void (*loaded)(void);
    const PostDialect *dialect; /* null in a model */
    const PostModel *model;     /* null in a dialect */
    PostText about;             /* what it is, in one sentence; may be empty */
} PostPlugin;

/* The fields of PostPlugin up to `layout`. */
#define POST_HEAD(kind, table) \
    POST_MAGIC, POST_ABI, (kind), (uint32_t)sizeof(PostPlugin), (uint32_t)sizeof(table), POST_LAYOUT
/* A PostText of a string literal. */
#define POST_TEXT(literal) {(const uint8_t *)(literal), sizeof(literal) - 1}
/* In front of the constant that a library exports. In C it needs a declaration with it as well. */
#define POST_EXPORT POST_LANGUAGE POST_VISIBLE

#ifdef __cplusplus
}
#endif

/* generated: begin */
#define POST_MAGIC 0x47554c5054534f50u
#define POST_LAYOUT 0xf97d5a5d8a758ecdu
#define POST_ABI 2u
#define POST_KIND_DIALECT 1u
#define POST_KIND_MODEL 2u
#define POST_MAX_WORDS 32u
#define POST_OPTION_FLAG 1u
#define POST_OPTION_INTEGER 2u
#define POST_OPTION_NUMBER 3u
#define POST_OPTION_TEXT 4u
#define POST_OPTION_CHOICE 5u
#define POST_OPTION_LINES 6u
#define POST_UNITS_MILLIMETRE 1u
#define POST_UNITS_INCH 2u
#define POST_FEED_NONE 0u
#define POST_FEED_PER_MINUTE 1u
#define POST_FEED_INVERSE_TIME 2u
#define POST_FEED_PER_REVOLUTION 3u
#define POST_SPINDLE_OFF 0u
#define POST_SPINDLE_CLOCKWISE 1u
#define POST_SPINDLE_COUNTER_CLOCKWISE 2u
#define POST_SPINDLE_ORIENT 3u
#define POST_SENSE_CLOCKWISE 1u
#define POST_SENSE_COUNTER_CLOCKWISE 2u
#define POST_COOLANT_OFF 0u
#define POST_COOLANT_FLOOD 1u
#define POST_COOLANT_MIST 2u
#define POST_COOLANT_THROUGH 3u
#define POST_COOLANT_AIR 4u
#define POST_COMPENSATE_OFF 0u
#define POST_COMPENSATE_LEFT 1u
#define POST_COMPENSATE_RIGHT 2u
#define POST_CYCLE_DRILL 1u
#define POST_CYCLE_DEEP 2u
#define POST_CYCLE_BREAK_CHIP 3u
#define POST_CYCLE_TAP 4u
#define POST_CYCLE_TAP_LEFT 5u
#define POST_CYCLE_REAM 6u
#define POST_CYCLE_BORE 7u
#define POST_CYCLE_BORE_FINE 8u
#define POST_CYCLE_BORE_BACK 9u
#define POST_PLANE_ROTARY 0u
#define POST_PLANE_ZXZ 1u
#define POST_PLANE_XYZ 2u
#define POST_PLANE_XZY 3u
#define POST_PLANE_YXZ 4u
#define POST_PLANE_YZX 5u
#define POST_PLANE_ZXY 6u
#define POST_PLANE_ZYX 7u
#define POST_LANGUAGE_MACRO 0u
#define POST_LANGUAGE_RS274 1u
#define POST_LANGUAGE_NAMES 2u
#define POST_LANGUAGE_CONVERSATIONAL 3u
#define POST_LANGUAGE_INSTRUCTIONS 4u
#define POST_LANGUAGE_JOINTS 5u
/* Arc in the plane of X and Y (G17). */
#define POST_WRITES_ARC_XY 0x0000000000000001u
/* Arc in the plane of Z and X (G18). */
#define POST_WRITES_ARC_ZX 0x0000000000000002u
/* Arc in the plane of Y and Z (G19). */
#define POST_WRITES_ARC_YZ 0x0000000000000004u
/* Arc about any direction. */
#define POST_WRITES_ARC_ANY 0x0000000000000008u
/* Arc that ends off the plane of its start, in the planes declared. */
#define POST_WRITES_HELIX 0x0000000000000010u
/* Arc also while tool centre point control is on. */
#define POST_WRITES_ARC_TCP 0x0000000000000020u
/* Spline. */
#define POST_WRITES_SPLINE 0x0000000000000040u
/* Plane and PlaneOff. */
#define POST_WRITES_PLANE 0x0000000000000080u
/* Cycles and arcs inside a Plane. */
#define POST_WRITES_CYCLE_IN_PLANE 0x0000000000000100u
/* Cycles along any tool axis, without a Plane. */
#define POST_WRITES_CYCLE_ANY_AXIS 0x0000000000000200u
/* Cycle of kind Drill. */
#define POST_WRITES_CYCLE_DRILL 0x0000000000000400u
/* Cycle of kind Deep. */
#define POST_WRITES_CYCLE_DEEP 0x0000000000000800u
/* Cycle of kind BreakChip. */
#define POST_WRITES_CYCLE_BREAK_CHIP 0x0000000000001000u
/* Cycle of kind Tap. */
#define POST_WRITES_CYCLE_TAP 0x0000000000002000u
/* Cycle of kind TapLeft. */
#define POST_WRITES_CYCLE_TAP_LEFT 0x0000000000004000u
/* Cycle of kind Ream. */
#define POST_WRITES_CYCLE_REAM 0x0000000000008000u
/* Cycle of kind Bore. */
#define POST_WRITES_CYCLE_BORE 0x0000000000010000u
/* Cycle of kind BoreFine. */
#define POST_WRITES_CYCLE_BORE_FINE 0x0000000000020000u
/* Cycle of kind BoreBack. */
#define POST_WRITES_CYCLE_BORE_BACK 0x0000000000040000u
/* Smoothing and SmoothingOff. */
#define POST_WRITES_SMOOTHING 0x0000000000080000u
/* Tcp. */
#define POST_WRITES_TCP_SWITCH 0x0000000000100000u
/* The tool vector of a move instead of its rotary words. */
#define POST_WRITES_TOOL_VECTOR 0x0000000000200000u
/* Operation and OperationEnd. */
#define POST_WRITES_OPERATION 0x0000000000400000u
/* Message. */
#define POST_WRITES_MESSAGE 0x0000000000800000u
/* Units. */
#define POST_WRITES_UNITS 0x0000000001000000u
/* WorkOffset. */
#define POST_WRITES_WORK_OFFSET 0x0000000002000000u
/* Offsets. */
#define POST_WRITES_OFFSETS 0x0000000004000000u
/* SurfaceSpeed. */
#define POST_WRITES_SURFACE_SPEED 0x0000000008000000u
/* Clamp. */
#define POST_WRITES_CLAMP 0x0000000010000000u
/* Surface. */
#define POST_WRITES_SURFACE 0x0000000020000000u
/* Compensate3d. */
#define POST_WRITES_COMPENSATE_3D 0x0000000040000000u
/* Subprogram. */
#define POST_WRITES_SUBPROGRAM 0x0000000080000000u
/* Probe. */
#define POST_WRITES_PROBE 0x0000000100000000u
/* Compensate also while tool centre point control is on: the control offsets by the whole radius in the plane of
 * X and Y of the part. */
#define POST_WRITES_COMPENSATE_TCP 0x0000000200000000u
/* No registers: length and radius are those that the control's own table has for the tool in the spindle. */
#define POST_WRITES_TOOL_TABLE 0x0000000400000000u
/* Tool centre point control is switched on in a block that moves nothing, so that a first position can go in the
 * plane and then in depth under it. */
#define POST_WRITES_TCP_STILL 0x0000000800000000u
/* Instead. */
#define POST_WRITES_INSTEAD 0x0000001000000000u
/* Arc by its radius. */
#define POST_WRITES_ARC_RADIUS 0x0000002000000000u
/* Cycles also while tool centre point control is on, the tool upright on the part's X and Y. */
#define POST_WRITES_CYCLE_TCP 0x0000004000000000u
/* The tool's length is put along the depth axis, whichever of X, Y and Z that is (G18, TOOL CALL 1 Y); else
 * along Z. */
#define POST_WRITES_LENGTH_ALONG_DEPTH 0x0000008000000000u
/* No length is put on: it is in the work offset. */
#define POST_WRITES_LENGTH_IN_OFFSET 0x0000010000000000u
/* Arc that ends off the plane of its start is told by its turn, to 0.00001 degrees: it ends as far from the
 * centre as it begins. */
#define POST_WRITES_HELIX_BY_TURN 0x0000020000000000u
/* A feed a minute without tool centre point control counts along all axes together, degrees as millimetres; else
 * along the linear ones. */
#define POST_WRITES_FEED_ALL_AXES 0x0000040000000000u
/* No retract of the host's own: where the control's machine coordinates end is not where the axis is known to
 * stand clear (its zero is the builder's, or lies on a switch), so that the machine file must say where to. */
#define POST_WRITES_RETRACT_SAID 0x0000080000000000u
/* Under tool centre point control rapids hold what the axes of the program can do, and a joint may pass its own
 * largest feed. */
#define POST_WRITES_TCP_RAPIDS_PASS 0x0000100000000000u
/* Length and radius are those of an edge of the tool, which D names: D1 is the first. */
#define POST_WRITES_TOOL_EDGES 0x0000200000000000u
/* Cuts. */
#define POST_WRITES_CUTS 0x0000400000000000u
/* Cycles do not wait at the bottom, or in a unit that is not known: a hole where the tool waits is made of
 * moves. */
#define POST_WRITES_CYCLE_NO_DWELL 0x0000800000000000u
/* WordLetter. */
#define POST_WRITES_WORD_LETTER 0x0001000000000000u
/* Words of rotary axes without ends as a place within one turn, whose sign is the way there. */
#define POST_WRITES_SIGN_IS_WAY 0x0002000000000000u
/* Pose: cuts that lead the tool of a robot straight. */
#define POST_WRITES_POSES 0x0004000000000000u
/* Where no linear axis moves, a feed a minute counts along the rotary axis that turns the most, in degrees; else
 * along the root of the sum of their squares. */
#define POST_WRITES_FEED_LONGEST_TURN 0x0008000000000000u
/* Park does not come: the control has no words for positions in machine coordinates. */
#define POST_WRITES_NO_PARK 0x0010000000000000u
/* G0 goes at F, as G1 does: rapid_feed of the format says at which. */
#define POST_WRITES_RAPIDS_AT_FEED 0x0020000000000000u
/* A line is one command, which stands first, and its parameters: no word of motion holds on to the next line,
 * and what stands in front of a command or behind it is not run as words of a block. The dialect names every
 * word that its control reads: what others of its language have in common does not hold. */
#define POST_WRITES_COMMAND_A_LINE 0x0040000000000000u
/* A parameter of the control says what its numbers count in, and a decimal point does not override it. */
#define POST_WRITES_UNIT_SYSTEM 0x0080000000000000u
/* The tool's length goes along the axis across the plane in force, also where the plane changes behind the word
 * that put it on: along Y behind G18. */
#define POST_WRITES_LENGTH_ACROSS_PLANE 0x0100000000000000u
/* Tolerances of its smoothing are in mm in inch programs too. */
#define POST_WRITES_SMOOTHING_IN_MM 0x0200000000000000u
/* The program begins: header, units, safe state. */
#define POST_EVENT_START 1u
/* A remark for the operator (PPRINT, the names of operations). */
#define POST_EVENT_COMMENT 2u
/* texts[0], text: One line, any characters: the dialect makes it safe. */
/* A line to be written letter for letter (INSERT). */
#define POST_EVENT_LITERAL 3u
/* texts[0], text: The line. */
/* Change to a tool. The tool before it was retracted, the spindle and the coolant stand still. */
#define POST_EVENT_TOOL_CHANGE 4u
/* Tool number. */
#define POST_AT_TOOL_CHANGE_NUMBER 0u
/* Register of the length compensation. */
#define POST_AT_TOOL_CHANGE_REGISTER 1u
/* From the gauge point to the tip, mm; none if not known. */
#define POST_AT_TOOL_CHANGE_LENGTH 2u
/* Of the cutter, mm; none if not known. */
#define POST_AT_TOOL_CHANGE_DIAMETER 3u
/* Of the cutter's corner, mm: half the diameter for a ball; none if not known. */
#define POST_AT_TOOL_CHANGE_CORNER_RADIUS 4u
/* texts[0], name: Its name, empty if not known. */
/* Bring a tool to the change position without changing. */
#define POST_EVENT_PRESELECT 5u
/* Tool number. */
#define POST_AT_PRESELECT_NUMBER 0u
/* Spindle on, off or oriented. */
#define POST_EVENT_SPINDLE 6u
/* 2 numbers: POST_SPINDLE_… and revolutions a minute. */
#define POST_AT_SPINDLE_SPINDLE 0u
/* Coolant. */
#define POST_EVENT_COOLANT 7u
/* POST_COOLANT_…. */
#define POST_AT_COOLANT_COOLANT 0u
/* Cutter radius compensation, in force from the next move on. Under Setup::tcp it is sent under COMPENSATE_TCP
 * alone. */
#define POST_EVENT_COMPENSATE 8u
/* 2 numbers: POST_COMPENSATE_… and the register of the radius. */
#define POST_AT_COMPENSATE_COMPENSATION 0u
/* The first position after a Event::Retract or a tool change. The tool stands clear of the part, the rotary axes
 * have been turned by Event::Turn (of an arm on axes that slide all go at once here). The dialect puts the
 * compensation in force (length compensation, or tool centre point control if Setup::tcp) in the order that its
 * control needs, and goes to the words at rapid. */
#define POST_EVENT_POSITION 9u
/* 6 numbers: Where the tool stands then; none where nobody knows. */
#define POST_AT_POSITION_TOOL 0u
/* 2 numbers: Feed of the last approach; none is rapid. */
#define POST_AT_POSITION_FEED 6u
/* The words of the plane move the tool across, that of the depth along the spindle, and nothing else: the plane
 * comes first, the depth last. Else (in a tilted plane under a head that leans; under tool centre point control
 * where the tool leans, the part is turned or the control has no block of its own that begins it; where the
 * machine file says how the tool leaves) all linear words stand in one block, and with them the rotary ones that
 * were not turned before. It leads to a point clear of the part, from which the next moves come in along the
 * tool. */
#define POST_AT_POSITION_PLANE_FIRST 8u
/* how many there are, and behind it as many: All axis words, in the order of Setup::words. */
#define POST_AT_POSITION_WORDS 9u
/* The tool leaves the part: axes go at rapid to where the machine file proves it to be clear, and what
 * Event::Position put in force (TCP, length) is cancelled, in the order that the control needs. Sent behind the
 * start too, when nothing is known of what is in force; never twice without a motion, a tool change or an
 * Event::Word between. */
#define POST_EVENT_RETRACT 10u
/* Which words: bit n is word n. */
#define POST_AT_RETRACT_AXES 0u
/* how many there are, and behind it as many: Positions in machine coordinates (G53, M91, SUPA), in program
 * units; 0 for words that stay. */
#define POST_AT_RETRACT_WORDS 1u
/* Rapid traverse. */
#define POST_EVENT_RAPID 11u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_AT_RAPID_TOOL 0u
/* how many there are, and behind it as many: All axis words. */
#define POST_AT_RAPID_WORDS 6u
/* A cut: all axes move linearly in time. */
#define POST_EVENT_LINEAR 12u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_AT_LINEAR_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_AT_LINEAR_FEED 6u
/* how many there are, and behind it as many: All axis words. */
#define POST_AT_LINEAR_WORDS 8u
/* Wait. */
#define POST_EVENT_DWELL 13u
/* Seconds. */
#define POST_AT_DWELL_SECONDS 0u
/* Unconditional stop (M0). */
#define POST_EVENT_STOP 14u
/* Optional stop (M1). */
#define POST_EVENT_OPTIONAL_STOP 15u
/* After a Event::Retract: axes go at rapid to a position of the machine (for a tool change, at the end). */
#define POST_EVENT_PARK 16u
/* Which words: bit n is word n. */
#define POST_AT_PARK_AXES 0u
/* how many there are, and behind it as many: Positions in machine coordinates, in program units; 0 for words
 * that stay. */
#define POST_AT_PARK_WORDS 1u
/* The program ends. */
#define POST_EVENT_END 17u
/* The rotary axes turn at rapid to their words, the tool retracted; the linear axes stay. Comes ahead of
 * Event::Position, what clamps them between the two. */
#define POST_EVENT_TURN 18u
/* how many there are, and behind it as many: All axis words: of these the rotary ones count. */
#define POST_AT_TURN_WORDS 0u
/* A line of the machine builder's own (a clamp, another head), to be written letter for letter. It moves
 * nothing, and what is in force stays in force. */
#define POST_EVENT_WORD 19u
/* texts[0], text: The line. */
/* An operation begins. Sent under Capabilities::OPERATION, else its name is a remark. */
#define POST_EVENT_OPERATION 20u
/* texts[0], name: Its name in the CAM system, empty if it has none. */
/* The operation ends. Under the same capability. */
#define POST_EVENT_OPERATION_END 21u
/* A message on the control's screen (MSG), under MESSAGE. */
#define POST_EVENT_MESSAGE 22u
/* texts[0], text: One line, any characters; empty clears it. */
/* Units change inside the program, under UNITS; no length is in force across it. */
#define POST_EVENT_UNITS 23u
/* POST_UNITS_…. */
#define POST_AT_UNITS_UNITS 0u
/* Another work offset, under WORK_OFFSET. The tool was retracted before. */
#define POST_EVENT_WORK_OFFSET 24u
/* From 1: G54 is 1, G55 is 2. */
#define POST_AT_WORK_OFFSET_NUMBER 0u
/* texts[0], name: As the CL file names it, empty if it does not. */
/* Other registers for the tool in the spindle, under OFFSETS. */
#define POST_EVENT_OFFSETS 25u
/* Register of the length; none stays. */
#define POST_AT_OFFSETS_LENGTH 0u
/* Register of the radius; none stays. */
#define POST_AT_OFFSETS_RADIUS 1u
/* Spindle on at a constant cutting speed, under SURFACE_SPEED. */
#define POST_EVENT_SURFACE_SPEED 26u
/* m/min, or feet a minute in an inch program. */
#define POST_AT_SURFACE_SPEED_SPEED 0u
/* Revolutions a minute that it must not exceed; none if not said. */
#define POST_AT_SURFACE_SPEED_MOST 1u
/* POST_SENSE_…. */
#define POST_AT_SURFACE_SPEED_SENSE 2u
/* Tool centre point control on or off by itself, under TCP_SWITCH: on ahead of Event::Position, off ahead of
 * Event::Retract; else these two do it, in the order that the control needs. */
#define POST_EVENT_TCP 27u
/* On, else off. */
#define POST_AT_TCP_ON 0u
/* A tilted plane begins, under PLANE: until Event::PlaneOff linear words are in its frame, and Event::Position
 * puts the length in force, no tool centre point control. The tool was retracted before. */
#define POST_EVENT_PLANE 28u
/* 3 numbers: Origin of the plane's frame, mm, part frame; a number that the linear words can print. */
#define POST_AT_PLANE_ORIGIN 0u
/* 3 numbers: Its first direction, unit vector, part frame: that of the machine's X as it runs against the part
 * at words, laid across z. */
#define POST_AT_PLANE_X 3u
/* 3 numbers: Its normal, unit vector, part frame: the tool axis. */
#define POST_AT_PLANE_Z 6u
/* 3 numbers: The plane by Format::plane_angles, degrees, rounded to its decimals: x and z follow from these;
 * zero where the format has none. */
#define POST_AT_PLANE_ANGLES 9u
/* how many there are, and behind it as many: Where the axes stand in it: of these the rotary words count. The
 * axes have been turned there by an Event::Turn, so that a control which looks for its own solution finds the
 * tool upright already. */
#define POST_AT_PLANE_WORDS 12u
/* The tilted plane ends. The tool was retracted before. */
#define POST_EVENT_PLANE_OFF 29u
/* The control may leave the path by so much, under SMOOTHING (G187, CYCLE832, CYCL DEF 32, G61.1). The tool was
 * retracted before; so it was before its end. */
#define POST_EVENT_SMOOTHING 30u
/* Of the tip, mm. */
#define POST_AT_SMOOTHING_TOLERANCE 0u
/* Of the tool axis, degrees; none where it does not turn. */
#define POST_AT_SMOOTHING_AXIS_TOLERANCE 1u
/* The control keeps the path exactly, or as it does by default. */
#define POST_EVENT_SMOOTHING_OFF 31u
/* A rotary axis is clamped or let go, under CLAMP; else the machine file's own word comes as Event::Word. */
#define POST_EVENT_CLAMP 32u
/* Which word of the setup, from 0. */
#define POST_AT_CLAMP_WORD 0u
/* Clamped, else let go. */
#define POST_AT_CLAMP_ON 1u
/* An arc or a helix about normal, at a feed, under ARC_…, HELIX. */
#define POST_EVENT_ARC 33u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_AT_ARC_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_AT_ARC_FEED 6u
/* 3 numbers: Centre in the frame and the units of the linear words. */
#define POST_AT_ARC_CENTRE 8u
/* 3 numbers: Unit vector in that frame about which it turns. */
#define POST_AT_ARC_NORMAL 11u
/* Degrees from start to end, counter-clockwise seen against the normal; negative: clockwise. */
#define POST_AT_ARC_TURN 14u
/* The radius to be written in the place of the centre, under ARC_RADIUS: negative for an arc of more than half a
 * turn. None: the centre is written. */
#define POST_AT_ARC_RADIUS 15u
/* how many there are, and behind it as many: All axis words at its end; a helix ends off the plane of its start. */
#define POST_AT_ARC_WORDS 16u
/* A spline at a feed, under SPLINE. */
#define POST_EVENT_SPLINE 34u
/* 2 numbers: Its feed. */
#define POST_AT_SPLINE_FEED 0u
/* Degree. */
#define POST_AT_SPLINE_DEGREE 2u
/* how many there are, and behind it as many: Knots. */
#define POST_AT_SPLINE_KNOTS 3u
/* then weights, how many there are, and behind it as many: A weight for each control point. */
/* then points, how many there are, and behind it as many: All axis words of the first control point, then of the
 * second, and so on. */
/* A drilling cycle is in force at each Event::CyclePoint from here on, under CYCLE_… of its kind. Lengths are
 * in program units, along the tool axis. */
#define POST_EVENT_CYCLE 35u
/* POST_CYCLE_…. */
#define POST_AT_CYCLE_CYCLE 0u
/* 2 numbers: Its feed. */
#define POST_AT_CYCLE_FEED 1u
/* From the point down to the bottom. */
#define POST_AT_CYCLE_DEPTH 3u
/* From the point up to where the feed begins. */
#define POST_AT_CYCLE_CLEARANCE 4u
/* From the point up to where the tool goes on the way to the next one. */
#define POST_AT_CYCLE_RETRACT 5u
/* Into the part in one go; none if it goes in one. */
#define POST_AT_CYCLE_STEP 6u
/* At the bottom, seconds; none if it does not wait. Never of Deep, BreakChip and Bore. */
#define POST_AT_CYCLE_DWELL 7u
/* A thread's way a turn; none if the feed says it. */
#define POST_AT_CYCLE_PITCH 8u
/* A point of the cycle in force. */
#define POST_EVENT_CYCLE_POINT 36u
/* 6 numbers: Where the tool would stand on it; none where nobody knows. */
#define POST_AT_CYCLE_POINT_TOOL 0u
/* how many there are, and behind it as many: All axis words with the tip on the point. */
#define POST_AT_CYCLE_POINT_WORDS 6u
/* No cycle is in force any more; the tool stands at the last point's retract level. */
#define POST_EVENT_CYCLE_OFF 37u
/* A cut with the surface's normal, under SURFACE (LN, 3-D compensation). */
#define POST_EVENT_SURFACE 38u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_AT_SURFACE_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_AT_SURFACE_FEED 6u
/* 3 numbers: Unit vector out of the part, part frame. */
#define POST_AT_SURFACE_NORMAL 8u
/* how many there are, and behind it as many: All axis words. */
#define POST_AT_SURFACE_WORDS 11u
/* Compensation of the tool's size in space, under COMPENSATE_3D. */
#define POST_EVENT_COMPENSATE_3D 39u
/* On, else off. */
#define POST_AT_COMPENSATE_3D_ON 0u
/* Register of the radius. */
#define POST_AT_COMPENSATE_3D_REGISTER 1u
/* A subprogram is called, under SUBPROGRAM. Afterwards nothing is known to be in force. */
#define POST_EVENT_SUBPROGRAM 40u
/* Its number; none if it has a name. */
#define POST_AT_SUBPROGRAM_NUMBER 0u
/* How often. */
#define POST_AT_SUBPROGRAM_TIMES 1u
/* texts[0], name: Its name, empty if it has a number. */
/* A move until the probe touches, under PROBE. */
#define POST_EVENT_PROBE 41u
/* 6 numbers: Where the tool would stand at its end; none where nobody knows. */
#define POST_AT_PROBE_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_AT_PROBE_FEED 6u
/* how many there are, and behind it as many: All axis words of its end. */
#define POST_AT_PROBE_WORDS 8u
/* Lines of the user's own in the place of those that the event behind this one would write, under INSTEAD. What
 * that event puts in force is in force all the same. In front of a Event::Retract they stand for the way alone:
 * what the control must cancel is cancelled around them; in front of Event::End for the words that end the
 * program: what closes its file (%) stands behind them. */
#define POST_EVENT_INSTEAD 42u
/* texts[0], text: One or more lines, each ended by a line feed but the last. */
/* Cuts one behind the other, under CUTS: what a Linear of each would be, and the same text. Where the tool
 * stands is not told. */
#define POST_EVENT_CUTS 43u
/* 2 numbers: Kind of all their feeds, and the first of them. */
#define POST_AT_CUTS_FEED 0u
/* how many there are, and behind it as many: The feeds of all cuts, then the first axis word of all of them,
 * then the second, and so on. */
#define POST_AT_CUTS_COLUMNS 2u
/* A word of an axis means something else from here on, under WORD_LETTER: a coordinate of the control's own, in
 * its polar interpolation, or the axis itself again. Which axis stands where is not known behind it. */
#define POST_EVENT_WORD_LETTER 44u
/* Which word of the setup, from 0. */
#define POST_AT_WORD_LETTER_WORD 0u
/* It is a coordinate, a length; else the axis itself. */
#define POST_AT_WORD_LETTER_COORDINATE 1u
/* texts[0], letter: The letter behind which it stands. */
/* How the tool stands at the end of the cut that comes next, under POSES: the control leads it there straight,
 * turned evenly about one direction. The frame of the tool has its origin in the tip and its Z from the spindle
 * to the tip; its X is that of the machine frame, laid across, where all axes are at zero. */
#define POST_EVENT_POSE 45u
/* 3 numbers: The tip, mm, machine frame. */
#define POST_AT_POSE_ORIGIN 0u
/* 4 numbers: How the frame is turned against the machine's: a unit quaternion, the scalar first. */
#define POST_AT_POSE_QUATERNION 3u
/* 3 numbers: The same as a turn about its own direction, radians. */
#define POST_AT_POSE_ROTATION 7u
/* 3 numbers: The same as turns about Z, then about the new Y, then about the new X, degrees. */
#define POST_AT_POSE_ANGLES 10u
/* generated: end */

/* Helpers. None of them reads past what an event or a setup says that it has. */

/* The number of an event at a place, POST_AT_…; NaN (which is not given) where the event has fewer. */
static inline double post_number(const PostEvent *event, size_t at) {
    return at < event->numbers_len ? event->numbers[at] : (double)NAN;
}

/* The list of an event whose count stands at a place, POST_AT_…, and in `len` how many numbers it has: null and 0 where
 * the event has fewer than the count says. The list behind it has its count at `at + 1 + *len`. */
static inline const double *post_list(const PostEvent *event, size_t at, size_t *len) {
    double count = post_number(event, at);
    *len = 0;
    if (!(count >= 0) || count > (double)(event->numbers_len - at - 1))
        return NULL;
    *len = (size_t)count;
    return event->numbers + at + 1;
}

/* The text of an event at a place; empty where the event has fewer. */
static inline PostText post_text(const PostEvent *event, size_t at) {
    PostText none = POST_TEXT("");
    return at < event->texts_len ? event->texts[at] : none;
}

/* The text of a string that ends with a zero and outlives the call. */
static inline PostText post_string(const char *string) {
    PostText text = POST_TEXT("");
    text.ptr = (const uint8_t *)string;
    text.len = strlen(string);
    return text;
}

/* The value of an option by its key; null where the plugin does not declare it. */
static inline const PostValue *post_option(const PostPair *options, size_t len, const char *key) {
    for (size_t i = 0; i < len; i++)
        if (options[i].key.len == strlen(key) && memcmp(options[i].key.ptr, key, strlen(key)) == 0)
            return &options[i].value;
    return NULL;
}

/* What `describe` emits for an option: of a kind, with nothing else said. */
static inline PostOption post_option_of(uint32_t kind, const char *key, const char *help) {
    PostOption option;
    memset(&option, 0, sizeof option);
    option.key = post_string(key);
    option.help = post_string(help);
    option.kind = option.default_value.kind = kind;
    return option;
}

/* Yes or no. */
static inline PostOption post_flag_option(const char *key, const char *help, int value) {
    PostOption option = post_option_of(POST_OPTION_FLAG, key, help);
    option.default_value.integer = value != 0;
    return option;
}

/* A whole number from `least` to `largest`, both allowed. */
static inline PostOption post_integer_option(const char *key, const char *help, int64_t least, int64_t largest,
                                             int64_t value) {
    PostOption option = post_option_of(POST_OPTION_INTEGER, key, help);
    option.min = (double)least;
    option.max = (double)largest;
    option.default_value.integer = value;
    return option;
}

/* A number from `least` to `largest`, both allowed. */
static inline PostOption post_number_option(const char *key, const char *help, double least, double largest,
                                            double value) {
    PostOption option = post_option_of(POST_OPTION_NUMBER, key, help);
    option.min = least;
    option.max = largest;
    option.default_value.number = value;
    return option;
}

/* One of `len` choices, which outlive the call. */
static inline PostOption post_choice_option(const char *key, const char *help, const PostText *choices, size_t len,
                                            const char *value) {
    PostOption option = post_option_of(POST_OPTION_CHOICE, key, help);
    option.choices = choices;
    option.choices_len = len;
    option.default_value.text = post_string(value);
    return option;
}

/* Hands a string that ends with a zero to a sink. */
static inline void post_put(const PostSink *sink, const char *string) {
    sink->write(sink->ctx, (const uint8_t *)string, strlen(string));
}

#include "post_plugin_tables.h"

#endif
