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
 * This header is for 64-bit machines; the assertions at its end say so if it is not one.
 * The block between the marks is written by `UPDATE_HEADER=1 cargo test -p post-plugin --test it header`.
 */
#ifndef POST_PLUGIN_H
#define POST_PLUGIN_H

#include <stddef.h>
#include <stdint.h>

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

/* `rotary`: 1 for degrees, 2 if its words also lie within one turn, so that the control must take the shorter way.
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
} PostSetup;

/* One step of a program. What its numbers and texts are stands below at POST_EVENT_ of its kind; POST_LINEAR_FEED
 * is the place of the feed among the numbers of a POST_EVENT_LINEAR. A feed is two numbers, POST_FEED_ and its
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
 * with `plane_decimals`. `language` is POST_LANGUAGE_: what programs are read back by, 0 (MACRO) if you do not say. */
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
#define POST_ASSERT static_assert
#define POST_ALIGN alignof
#else
#define POST_ASSERT _Static_assert
#define POST_ALIGN _Alignof
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
#define POST_MEANING_REMARK 1u
#define POST_MEANING_REMARK_OPEN 2u
#define POST_MEANING_REMARK_CLOSE 3u
#define POST_MEANING_BLOCK_NUMBER 4u
#define POST_MEANING_NOTHING 5u
#define POST_MEANING_MILLIMETRE 10u
#define POST_MEANING_INCH 11u
#define POST_MEANING_ABSOLUTE 12u
#define POST_MEANING_INCREMENTAL 13u
#define POST_MEANING_PLANE_XY 14u
#define POST_MEANING_PLANE_ZX 15u
#define POST_MEANING_PLANE_YZ 16u
#define POST_MEANING_RAPID 20u
#define POST_MEANING_LINEAR 21u
#define POST_MEANING_ARC_CLOCKWISE 22u
#define POST_MEANING_ARC_COUNTER_CLOCKWISE 23u
#define POST_MEANING_CENTRE_X 24u
#define POST_MEANING_CENTRE_Y 25u
#define POST_MEANING_CENTRE_Z 26u
#define POST_MEANING_RADIUS 27u
#define POST_MEANING_SPLINE 28u
#define POST_MEANING_MACHINE_COORDINATES 29u
#define POST_MEANING_FEED 30u
#define POST_MEANING_FEED_PER_MINUTE 31u
#define POST_MEANING_INVERSE_TIME 32u
#define POST_MEANING_FEED_PER_REVOLUTION 33u
#define POST_MEANING_RAPID_BLOCK 34u
#define POST_MEANING_LENGTH_ON 40u
#define POST_MEANING_LENGTH_OFF 41u
#define POST_MEANING_LENGTH_REGISTER 42u
#define POST_MEANING_COMPENSATION_OFF 43u
#define POST_MEANING_COMPENSATION_LEFT 44u
#define POST_MEANING_COMPENSATION_RIGHT 45u
#define POST_MEANING_RADIUS_REGISTER 46u
#define POST_MEANING_TCP_ON 47u
#define POST_MEANING_TCP_OFF 48u
#define POST_MEANING_TILTED_PLANE 50u
#define POST_MEANING_TILTED_PLANE_TURN 51u
#define POST_MEANING_TILTED_PLANE_OFF 52u
#define POST_MEANING_WORK_OFFSET 53u
#define POST_MEANING_SMOOTHING 54u
#define POST_MEANING_SMOOTHING_OFF 55u
#define POST_MEANING_TOOL 60u
#define POST_MEANING_TOOL_CHANGE 61u
#define POST_MEANING_SPINDLE_SPEED 62u
#define POST_MEANING_SPINDLE_CLOCKWISE 63u
#define POST_MEANING_SPINDLE_COUNTER_CLOCKWISE 64u
#define POST_MEANING_SPINDLE_OFF 65u
#define POST_MEANING_SPINDLE_ORIENT 66u
#define POST_MEANING_COOLANT_ON 67u
#define POST_MEANING_COOLANT_OFF 68u
#define POST_MEANING_DWELL 70u
#define POST_MEANING_STOP 71u
#define POST_MEANING_OPTIONAL_STOP 72u
#define POST_MEANING_END 73u
#define POST_MEANING_SUBPROGRAM 74u
#define POST_MEANING_PROBE 75u
#define POST_MEANING_CYCLE_DRILL 80u
#define POST_MEANING_CYCLE_DEEP 81u
#define POST_MEANING_CYCLE_BREAK_CHIP 82u
#define POST_MEANING_CYCLE_TAP 83u
#define POST_MEANING_CYCLE_TAP_LEFT 84u
#define POST_MEANING_CYCLE_REAM 85u
#define POST_MEANING_CYCLE_BORE 86u
#define POST_MEANING_CYCLE_BORE_FINE 87u
#define POST_MEANING_CYCLE_BORE_BACK 88u
#define POST_MEANING_CYCLE_OFF 89u
#define POST_MEANING_RETURN_START 90u
#define POST_MEANING_RETURN_CLEARANCE 91u
#define POST_MEANING_REFERENCE_RETURN 100u
#define POST_MEANING_OTHER_REFERENCE_RETURN 101u
#define POST_MEANING_RETRACT 102u
#define POST_MEANING_BUILDER_COORDINATES 103u
#define POST_MEANING_EXACT_STOP 104u
#define POST_MEANING_THREAD 105u
#define POST_MEANING_THREAD_AND_BACK 106u
#define POST_MEANING_THREAD_BACK 107u
#define POST_MEANING_LOCAL_OFFSET 110u
#define POST_MEANING_LOCAL_OFFSET_ADDED 111u
#define POST_MEANING_LOCAL_OFFSET_OFF 112u
#define POST_MEANING_SET_POSITION 113u
#define POST_MEANING_SET_POSITION_OFF 114u
#define POST_MEANING_SET_POSITION_AGAIN 115u
#define POST_MEANING_WORK_OFFSET_OFF 116u
#define POST_MEANING_WORK_OFFSET_BLOCK 117u
#define POST_MEANING_TABLE_DATA 118u
#define POST_MEANING_TABLE_DATA_OFF 119u
#define POST_MEANING_ROTATION 120u
#define POST_MEANING_ROTATION_ADDED 121u
#define POST_MEANING_ROTATION_OFF 122u
#define POST_MEANING_SCALE 123u
#define POST_MEANING_SCALE_OFF 124u
#define POST_MEANING_MIRROR 125u
#define POST_MEANING_MIRROR_OFF 126u
#define POST_MEANING_POLAR 130u
#define POST_MEANING_POLAR_OFF 131u
#define POST_MEANING_FACE_TRANSFORMATION 132u
#define POST_MEANING_FACE_TRANSFORMATION_OFF 133u
#define POST_MEANING_CYLINDER_TRANSFORMATION 134u
#define POST_MEANING_CENTRE_ABSOLUTE 135u
#define POST_MEANING_CENTRE_INCREMENTAL 136u
#define POST_MEANING_DIAMETER 137u
#define POST_MEANING_DIAMETER_OFF 138u
#define POST_MEANING_ROTARY_SHORTEST 139u
#define POST_MEANING_ROTARY_AS_WRITTEN 140u
#define POST_MEANING_TCP_VECTOR_ON 141u
#define POST_MEANING_LENGTH_ALONG_TOOL 142u
#define POST_MEANING_LENGTH_STATED 143u
#define POST_MEANING_LENGTH_ADDED 144u
#define POST_MEANING_LENGTH_NEGATIVE 145u
#define POST_MEANING_TOOL_AXIS_X 146u
#define POST_MEANING_TOOL_AXIS_Y 147u
#define POST_MEANING_TOOL_AXIS_Z 148u
#define POST_MEANING_NORMAL_X 149u
#define POST_MEANING_NORMAL_Y 150u
#define POST_MEANING_NORMAL_Z 151u
#define POST_MEANING_ORIENTATION_PART 152u
#define POST_MEANING_ORIENTATION_MACHINE 153u
#define POST_MEANING_ORIENTATION_AXES 154u
#define POST_MEANING_ORIENTATION_VECTOR 155u
#define POST_MEANING_ORIENTATION_ANGLES 156u
#define POST_MEANING_PRESELECT 160u
#define POST_MEANING_SPINDLE_CLOCKWISE_COOLANT 161u
#define POST_MEANING_SPINDLE_COUNTER_CLOCKWISE_COOLANT 162u
#define POST_MEANING_SURFACE_SPEED 163u
#define POST_MEANING_SURFACE_SPEED_OFF 164u
#define POST_MEANING_SPEED_LIMIT 165u
#define POST_MEANING_CLAMP 166u
#define POST_MEANING_UNCLAMP 167u
#define POST_MEANING_SUBPROGRAM_END 170u
#define POST_MEANING_LOCAL_SUBPROGRAM 171u
#define POST_MEANING_MACRO 172u
#define POST_MEANING_MACRO_MODAL 173u
#define POST_MEANING_MACRO_OFF 174u
#define POST_MEANING_CYCLE_CALL 175u
#define POST_MEANING_CYCLE_CALL_MODAL 176u
#define POST_MEANING_CYCLE_OTHER 177u
#define POST_MEANING_RETURN_LEVEL 178u
#define POST_MEANING_DWELL_SECONDS 180u
#define POST_MEANING_DWELL_MILLISECONDS 181u
#define POST_MEANING_DWELL_TURNS 182u
#define POST_MEANING_ARC_THROUGH 183u
#define POST_MEANING_ARC_TANGENT 184u
#define POST_MEANING_TURNS 185u
#define POST_MEANING_ARC_ANGLE 186u
#define POST_MEANING_ROTARY_FEED_LENGTH 187u
#define POST_MEANING_ROTARY_FEED_ANGLE 188u
#define POST_MEANING_INCH_LENGTHS 189u
#define POST_MEANING_MILLIMETRE_LENGTHS 190u
#define POST_MEANING_CENTRE 191u
#define POST_MEANING_ARC 192u
#define POST_MEANING_FEED_PER_MINUTE_ALL_AXES 193u
#define POST_MEANING_MACHINE_COORDINATES_ON 194u
#define POST_MEANING_MACHINE_COORDINATES_OFF 195u
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
#define POST_TOOL_CHANGE_NUMBER 0u
/* Register of the length compensation. */
#define POST_TOOL_CHANGE_REGISTER 1u
/* From the gauge point to the tip, mm; none if not known. */
#define POST_TOOL_CHANGE_LENGTH 2u
/* Of the cutter, mm; none if not known. */
#define POST_TOOL_CHANGE_DIAMETER 3u
/* Of the cutter's corner, mm: half the diameter for a ball; none if not known. */
#define POST_TOOL_CHANGE_CORNER_RADIUS 4u
/* texts[0], name: Its name, empty if not known. */
/* Bring a tool to the change position without changing. */
#define POST_EVENT_PRESELECT 5u
/* Tool number. */
#define POST_PRESELECT_NUMBER 0u
/* Spindle on, off or oriented. */
#define POST_EVENT_SPINDLE 6u
/* 2 numbers: POST_SPINDLE_… and revolutions a minute. */
#define POST_SPINDLE_SPINDLE 0u
/* Coolant. */
#define POST_EVENT_COOLANT 7u
/* POST_COOLANT_…. */
#define POST_COOLANT_COOLANT 0u
/* Cutter radius compensation, in force from the next move on. Under Setup::tcp it is sent under COMPENSATE_TCP
 * alone. */
#define POST_EVENT_COMPENSATE 8u
/* 2 numbers: POST_COMPENSATE_… and the register of the radius. */
#define POST_COMPENSATE_COMPENSATION 0u
/* The first position after a Event::Retract or a tool change. The tool stands clear of the part, the rotary axes
 * have been turned by Event::Turn. The dialect puts the compensation in force (length compensation, or tool
 * centre point control if Setup::tcp) in the order that its control needs, and goes to the words at rapid. */
#define POST_EVENT_POSITION 9u
/* 6 numbers: Where the tool stands then; none where nobody knows. */
#define POST_POSITION_TOOL 0u
/* 2 numbers: Feed of the last approach; none is rapid. */
#define POST_POSITION_FEED 6u
/* The words of the plane move the tool across, that of the depth along the spindle, and nothing else: the plane
 * comes first, the depth last. Else (in a tilted plane under a head that leans; under tool centre point control
 * where the tool leans, the part is turned or the control has no block of its own that begins it; where the
 * machine file says how the tool leaves) all linear words stand in one block. It leads to a point clear of the
 * part, from which the next moves come in along the tool. */
#define POST_POSITION_PLANE_FIRST 8u
/* how many there are, and behind it as many: All axis words, in the order of Setup::words. */
#define POST_POSITION_WORDS 9u
/* The tool leaves the part: axes go at rapid to where the machine file proves it to be clear, and what
 * Event::Position put in force (TCP, length) is cancelled, in the order that the control needs. Sent behind the
 * start too, when nothing is known of what is in force; never twice without a motion, a tool change or an
 * Event::Word between. */
#define POST_EVENT_RETRACT 10u
/* Which words: bit n is word n. */
#define POST_RETRACT_AXES 0u
/* how many there are, and behind it as many: Positions in machine coordinates (G53, M91, SUPA), in program
 * units; 0 for words that stay. */
#define POST_RETRACT_WORDS 1u
/* Rapid traverse. */
#define POST_EVENT_RAPID 11u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_RAPID_TOOL 0u
/* how many there are, and behind it as many: All axis words. */
#define POST_RAPID_WORDS 6u
/* A cut: all axes move linearly in time. */
#define POST_EVENT_LINEAR 12u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_LINEAR_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_LINEAR_FEED 6u
/* how many there are, and behind it as many: All axis words. */
#define POST_LINEAR_WORDS 8u
/* Wait. */
#define POST_EVENT_DWELL 13u
/* Seconds. */
#define POST_DWELL_SECONDS 0u
/* Unconditional stop (M0). */
#define POST_EVENT_STOP 14u
/* Optional stop (M1). */
#define POST_EVENT_OPTIONAL_STOP 15u
/* After a Event::Retract: axes go at rapid to a position of the machine (for a tool change, at the end). */
#define POST_EVENT_PARK 16u
/* Which words: bit n is word n. */
#define POST_PARK_AXES 0u
/* how many there are, and behind it as many: Positions in machine coordinates, in program units; 0 for words
 * that stay. */
#define POST_PARK_WORDS 1u
/* The program ends. */
#define POST_EVENT_END 17u
/* The rotary axes turn at rapid to their words, the tool retracted; the linear axes stay. Comes ahead of
 * Event::Position, what clamps them between the two. */
#define POST_EVENT_TURN 18u
/* how many there are, and behind it as many: All axis words: of these the rotary ones count. */
#define POST_TURN_WORDS 0u
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
#define POST_UNITS_UNITS 0u
/* Another work offset, under WORK_OFFSET. The tool was retracted before. */
#define POST_EVENT_WORK_OFFSET 24u
/* From 1: G54 is 1, G55 is 2. */
#define POST_WORK_OFFSET_NUMBER 0u
/* texts[0], name: As the CL file names it, empty if it does not. */
/* Other registers for the tool in the spindle, under OFFSETS. */
#define POST_EVENT_OFFSETS 25u
/* Register of the length; none stays. */
#define POST_OFFSETS_LENGTH 0u
/* Register of the radius; none stays. */
#define POST_OFFSETS_RADIUS 1u
/* Spindle on at a constant cutting speed, under SURFACE_SPEED. */
#define POST_EVENT_SURFACE_SPEED 26u
/* m/min, or feet a minute in an inch program. */
#define POST_SURFACE_SPEED_SPEED 0u
/* Revolutions a minute that it must not exceed; none if not said. */
#define POST_SURFACE_SPEED_MOST 1u
/* POST_SENSE_…. */
#define POST_SURFACE_SPEED_SENSE 2u
/* Tool centre point control on or off by itself, under TCP_SWITCH: on ahead of Event::Position, off ahead of
 * Event::Retract; else these two do it, in the order that the control needs. */
#define POST_EVENT_TCP 27u
/* On, else off. */
#define POST_TCP_ON 0u
/* A tilted plane begins, under PLANE: until Event::PlaneOff linear words are in its frame, and Event::Position
 * puts the length in force, no tool centre point control. The tool was retracted before. */
#define POST_EVENT_PLANE 28u
/* 3 numbers: Origin of the plane's frame, mm, part frame; a number that the linear words can print. */
#define POST_PLANE_ORIGIN 0u
/* 3 numbers: Its first direction, unit vector, part frame: that of the machine's X as it runs against the part
 * at words, laid across z. */
#define POST_PLANE_X 3u
/* 3 numbers: Its normal, unit vector, part frame: the tool axis. */
#define POST_PLANE_Z 6u
/* 3 numbers: The plane by Format::plane_angles, degrees, rounded to its decimals: x and z follow from these;
 * zero where the format has none. */
#define POST_PLANE_ANGLES 9u
/* how many there are, and behind it as many: Where the axes stand in it: of these the rotary words count. The
 * axes have been turned there by an Event::Turn, so that a control which looks for its own solution finds the
 * tool upright already. */
#define POST_PLANE_WORDS 12u
/* The tilted plane ends. The tool was retracted before. */
#define POST_EVENT_PLANE_OFF 29u
/* The control may leave the path by so much, under SMOOTHING (G187, CYCLE832, CYCL DEF 32, G61.1). The tool was
 * retracted before; so it was before its end. */
#define POST_EVENT_SMOOTHING 30u
/* Of the tip, mm. */
#define POST_SMOOTHING_TOLERANCE 0u
/* Of the tool axis, degrees; none where it does not turn. */
#define POST_SMOOTHING_AXIS_TOLERANCE 1u
/* The control keeps the path exactly, or as it does by default. */
#define POST_EVENT_SMOOTHING_OFF 31u
/* A rotary axis is clamped or let go, under CLAMP; else the machine file's own word comes as Event::Word. */
#define POST_EVENT_CLAMP 32u
/* Which word of the setup, from 0. */
#define POST_CLAMP_WORD 0u
/* Clamped, else let go. */
#define POST_CLAMP_ON 1u
/* An arc or a helix about normal, at a feed, under ARC_…, HELIX. */
#define POST_EVENT_ARC 33u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_ARC_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_ARC_FEED 6u
/* 3 numbers: Centre in the frame and the units of the linear words. */
#define POST_ARC_CENTRE 8u
/* 3 numbers: Unit vector in that frame about which it turns. */
#define POST_ARC_NORMAL 11u
/* Degrees from start to end, counter-clockwise seen against the normal; negative: clockwise. */
#define POST_ARC_TURN 14u
/* The radius to be written in the place of the centre, under ARC_RADIUS: negative for an arc of more than half a
 * turn. None: the centre is written. */
#define POST_ARC_RADIUS 15u
/* how many there are, and behind it as many: All axis words at its end; a helix ends off the plane of its start. */
#define POST_ARC_WORDS 16u
/* A spline at a feed, under SPLINE. */
#define POST_EVENT_SPLINE 34u
/* 2 numbers: Its feed. */
#define POST_SPLINE_FEED 0u
/* Degree. */
#define POST_SPLINE_DEGREE 2u
/* how many there are, and behind it as many: Knots. */
#define POST_SPLINE_KNOTS 3u
/* then weights, how many there are, and behind it as many: A weight for each control point. */
/* then points, how many there are, and behind it as many: All axis words of the first control point, then of the
 * second, and so on. */
/* A drilling cycle is in force at each Event::CyclePoint from here on, under CYCLE_… of its kind. Lengths are
 * in program units, along the tool axis. */
#define POST_EVENT_CYCLE 35u
/* POST_CYCLE_…. */
#define POST_CYCLE_CYCLE 0u
/* 2 numbers: Its feed. */
#define POST_CYCLE_FEED 1u
/* From the point down to the bottom. */
#define POST_CYCLE_DEPTH 3u
/* From the point up to where the feed begins. */
#define POST_CYCLE_CLEARANCE 4u
/* From the point up to where the tool goes on the way to the next one. */
#define POST_CYCLE_RETRACT 5u
/* Into the part in one go; none if it goes in one. */
#define POST_CYCLE_STEP 6u
/* At the bottom, seconds; none if it does not wait. Never of Deep, BreakChip and Bore. */
#define POST_CYCLE_DWELL 7u
/* A thread's way a turn; none if the feed says it. */
#define POST_CYCLE_PITCH 8u
/* A point of the cycle in force. */
#define POST_EVENT_CYCLE_POINT 36u
/* 6 numbers: Where the tool would stand on it; none where nobody knows. */
#define POST_CYCLE_POINT_TOOL 0u
/* how many there are, and behind it as many: All axis words with the tip on the point. */
#define POST_CYCLE_POINT_WORDS 6u
/* No cycle is in force any more; the tool stands at the last point's retract level. */
#define POST_EVENT_CYCLE_OFF 37u
/* A cut with the surface's normal, under SURFACE (LN, 3-D compensation). */
#define POST_EVENT_SURFACE 38u
/* 6 numbers: Where the tool stands at its end; none where nobody knows. */
#define POST_SURFACE_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_SURFACE_FEED 6u
/* 3 numbers: Unit vector out of the part, part frame. */
#define POST_SURFACE_NORMAL 8u
/* how many there are, and behind it as many: All axis words. */
#define POST_SURFACE_WORDS 11u
/* Compensation of the tool's size in space, under COMPENSATE_3D. */
#define POST_EVENT_COMPENSATE_3D 39u
/* On, else off. */
#define POST_COMPENSATE_3D_ON 0u
/* Register of the radius. */
#define POST_COMPENSATE_3D_REGISTER 1u
/* A subprogram is called, under SUBPROGRAM. Afterwards nothing is known to be in force. */
#define POST_EVENT_SUBPROGRAM 40u
/* Its number; none if it has a name. */
#define POST_SUBPROGRAM_NUMBER 0u
/* How often. */
#define POST_SUBPROGRAM_TIMES 1u
/* texts[0], name: Its name, empty if it has a number. */
/* A move until the probe touches, under PROBE. */
#define POST_EVENT_PROBE 41u
/* 6 numbers: Where the tool would stand at its end; none where nobody knows. */
#define POST_PROBE_TOOL 0u
/* 2 numbers: Its feed. */
#define POST_PROBE_FEED 6u
/* how many there are, and behind it as many: All axis words of its end. */
#define POST_PROBE_WORDS 8u
/* Lines of the user's own in the place of those that the event behind this one would write, under INSTEAD. What
 * that event puts in force is in force all the same. In front of a Event::Retract they stand for the way alone:
 * what the control must cancel is cancelled around them. */
#define POST_EVENT_INSTEAD 42u
/* texts[0], text: One or more lines, each ended by a line feed but the last. */
/* Cuts one behind the other, under CUTS: what a Linear of each would be, and the same text. Where the tool
 * stands is not told. */
#define POST_EVENT_CUTS 43u
/* 2 numbers: Kind of all their feeds, and the first of them. */
#define POST_CUTS_FEED 0u
/* how many there are, and behind it as many: The feeds of all cuts, then the first axis word of all of them,
 * then the second, and so on. */
#define POST_CUTS_COLUMNS 2u
POST_ASSERT(sizeof(PostText) == 16 && POST_ALIGN(PostText) == 8, "PostText");
POST_ASSERT(offsetof(PostText, ptr) == 0, "PostText.ptr");
POST_ASSERT(offsetof(PostText, len) == 8, "PostText.len");
POST_ASSERT(sizeof(PostSink) == 16 && POST_ALIGN(PostSink) == 8, "PostSink");
POST_ASSERT(offsetof(PostSink, ctx) == 0, "PostSink.ctx");
POST_ASSERT(offsetof(PostSink, write) == 8, "PostSink.write");
POST_ASSERT(sizeof(PostValue) == 40 && POST_ALIGN(PostValue) == 8, "PostValue");
POST_ASSERT(offsetof(PostValue, kind) == 0, "PostValue.kind");
POST_ASSERT(offsetof(PostValue, reserved) == 4, "PostValue.reserved");
POST_ASSERT(offsetof(PostValue, integer) == 8, "PostValue.integer");
POST_ASSERT(offsetof(PostValue, number) == 16, "PostValue.number");
POST_ASSERT(offsetof(PostValue, text) == 24, "PostValue.text");
POST_ASSERT(sizeof(PostPair) == 56 && POST_ALIGN(PostPair) == 8, "PostPair");
POST_ASSERT(offsetof(PostPair, key) == 0, "PostPair.key");
POST_ASSERT(offsetof(PostPair, value) == 16, "PostPair.value");
POST_ASSERT(sizeof(PostOption) == 112 && POST_ALIGN(PostOption) == 8, "PostOption");
POST_ASSERT(offsetof(PostOption, key) == 0, "PostOption.key");
POST_ASSERT(offsetof(PostOption, help) == 16, "PostOption.help");
POST_ASSERT(offsetof(PostOption, kind) == 32, "PostOption.kind");
POST_ASSERT(offsetof(PostOption, reserved) == 36, "PostOption.reserved");
POST_ASSERT(offsetof(PostOption, min) == 40, "PostOption.min");
POST_ASSERT(offsetof(PostOption, max) == 48, "PostOption.max");
POST_ASSERT(offsetof(PostOption, default_value) == 56, "PostOption.default_value");
POST_ASSERT(offsetof(PostOption, choices) == 96, "PostOption.choices");
POST_ASSERT(offsetof(PostOption, choices_len) == 104, "PostOption.choices_len");
POST_ASSERT(sizeof(PostAxisWord) == 48 && POST_ALIGN(PostAxisWord) == 8, "PostAxisWord");
POST_ASSERT(offsetof(PostAxisWord, name) == 0, "PostAxisWord.name");
POST_ASSERT(offsetof(PostAxisWord, rotary) == 16, "PostAxisWord.rotary");
POST_ASSERT(offsetof(PostAxisWord, depth) == 20, "PostAxisWord.depth");
POST_ASSERT(offsetof(PostAxisWord, carries_part) == 24, "PostAxisWord.carries_part");
POST_ASSERT(offsetof(PostAxisWord, reserved) == 28, "PostAxisWord.reserved");
POST_ASSERT(offsetof(PostAxisWord, least) == 32, "PostAxisWord.least");
POST_ASSERT(offsetof(PostAxisWord, largest) == 40, "PostAxisWord.largest");
POST_ASSERT(sizeof(PostTool) == 48 && POST_ALIGN(PostTool) == 8, "PostTool");
POST_ASSERT(offsetof(PostTool, name) == 0, "PostTool.name");
POST_ASSERT(offsetof(PostTool, number) == 16, "PostTool.number");
POST_ASSERT(offsetof(PostTool, reserved) == 20, "PostTool.reserved");
POST_ASSERT(offsetof(PostTool, length) == 24, "PostTool.length");
POST_ASSERT(offsetof(PostTool, diameter) == 32, "PostTool.diameter");
POST_ASSERT(offsetof(PostTool, corner_radius) == 40, "PostTool.corner_radius");
POST_ASSERT(sizeof(PostEvent) == 40 && POST_ALIGN(PostEvent) == 8, "PostEvent");
POST_ASSERT(offsetof(PostEvent, kind) == 0, "PostEvent.kind");
POST_ASSERT(offsetof(PostEvent, texts_len) == 4, "PostEvent.texts_len");
POST_ASSERT(offsetof(PostEvent, line) == 8, "PostEvent.line");
POST_ASSERT(offsetof(PostEvent, numbers) == 16, "PostEvent.numbers");
POST_ASSERT(offsetof(PostEvent, numbers_len) == 24, "PostEvent.numbers_len");
POST_ASSERT(offsetof(PostEvent, texts) == 32, "PostEvent.texts");
POST_ASSERT(sizeof(PostDeviation) == 48 && POST_ALIGN(PostDeviation) == 8, "PostDeviation");
POST_ASSERT(offsetof(PostDeviation, tip) == 0, "PostDeviation.tip");
POST_ASSERT(offsetof(PostDeviation, axis) == 24, "PostDeviation.axis");
POST_ASSERT(sizeof(PostTolerance) == 16 && POST_ALIGN(PostTolerance) == 8, "PostTolerance");
POST_ASSERT(offsetof(PostTolerance, tip) == 0, "PostTolerance.tip");
POST_ASSERT(offsetof(PostTolerance, axis) == 8, "PostTolerance.axis");
POST_ASSERT(sizeof(PostCurve) == 512 && POST_ALIGN(PostCurve) == 8, "PostCurve");
POST_ASSERT(offsetof(PostCurve, tip_peak) == 0, "PostCurve.tip_peak");
POST_ASSERT(offsetof(PostCurve, tip_at) == 8, "PostCurve.tip_at");
POST_ASSERT(offsetof(PostCurve, axis_peak) == 16, "PostCurve.axis_peak");
POST_ASSERT(offsetof(PostCurve, axis_at) == 24, "PostCurve.axis_at");
POST_ASSERT(offsetof(PostCurve, terms) == 32, "PostCurve.terms");
POST_ASSERT(sizeof(PostSetup) == 200 && POST_ALIGN(PostSetup) == 8, "PostSetup");
POST_ASSERT(offsetof(PostSetup, size) == 0, "PostSetup.size");
POST_ASSERT(offsetof(PostSetup, program) == 8, "PostSetup.program");
POST_ASSERT(offsetof(PostSetup, machine) == 24, "PostSetup.machine");
POST_ASSERT(offsetof(PostSetup, units) == 40, "PostSetup.units");
POST_ASSERT(offsetof(PostSetup, tcp) == 44, "PostSetup.tcp");
POST_ASSERT(offsetof(PostSetup, words) == 48, "PostSetup.words");
POST_ASSERT(offsetof(PostSetup, words_len) == 56, "PostSetup.words_len");
POST_ASSERT(offsetof(PostSetup, options) == 64, "PostSetup.options");
POST_ASSERT(offsetof(PostSetup, options_len) == 72, "PostSetup.options_len");
POST_ASSERT(offsetof(PostSetup, cl_file) == 80, "PostSetup.cl_file");
POST_ASSERT(offsetof(PostSetup, tip_tolerance) == 96, "PostSetup.tip_tolerance");
POST_ASSERT(offsetof(PostSetup, axis_tolerance) == 104, "PostSetup.axis_tolerance");
POST_ASSERT(offsetof(PostSetup, rapid_tolerance) == 112, "PostSetup.rapid_tolerance");
POST_ASSERT(offsetof(PostSetup, ahead) == 120, "PostSetup.ahead");
POST_ASSERT(offsetof(PostSetup, moves) == 124, "PostSetup.moves");
POST_ASSERT(offsetof(PostSetup, tools) == 128, "PostSetup.tools");
POST_ASSERT(offsetof(PostSetup, tools_len) == 136, "PostSetup.tools_len");
POST_ASSERT(offsetof(PostSetup, least) == 144, "PostSetup.least");
POST_ASSERT(offsetof(PostSetup, largest) == 168, "PostSetup.largest");
POST_ASSERT(offsetof(PostSetup, time) == 192, "PostSetup.time");
POST_ASSERT(sizeof(PostFormat) == 104 && POST_ALIGN(PostFormat) == 8, "PostFormat");
POST_ASSERT(offsetof(PostFormat, size) == 0, "PostFormat.size");
POST_ASSERT(offsetof(PostFormat, words) == 8, "PostFormat.words");
POST_ASSERT(offsetof(PostFormat, feed) == 40, "PostFormat.feed");
POST_ASSERT(offsetof(PostFormat, inverse_time) == 44, "PostFormat.inverse_time");
POST_ASSERT(offsetof(PostFormat, feed_per_revolution) == 48, "PostFormat.feed_per_revolution");
POST_ASSERT(offsetof(PostFormat, words_len) == 52, "PostFormat.words_len");
POST_ASSERT(offsetof(PostFormat, extension) == 56, "PostFormat.extension");
POST_ASSERT(offsetof(PostFormat, writes) == 72, "PostFormat.writes");
POST_ASSERT(offsetof(PostFormat, most_inverse_time) == 80, "PostFormat.most_inverse_time");
POST_ASSERT(offsetof(PostFormat, plane_angles) == 88, "PostFormat.plane_angles");
POST_ASSERT(offsetof(PostFormat, plane_decimals) == 92, "PostFormat.plane_decimals");
POST_ASSERT(offsetof(PostFormat, language) == 96, "PostFormat.language");
POST_ASSERT(offsetof(PostFormat, reserved) == 100, "PostFormat.reserved");
POST_ASSERT(sizeof(PostPlugin) == 112 && POST_ALIGN(PostPlugin) == 8, "PostPlugin");
POST_ASSERT(offsetof(PostPlugin, magic) == 0, "PostPlugin.magic");
POST_ASSERT(offsetof(PostPlugin, abi) == 8, "PostPlugin.abi");
POST_ASSERT(offsetof(PostPlugin, kind) == 12, "PostPlugin.kind");
POST_ASSERT(offsetof(PostPlugin, size) == 16, "PostPlugin.size");
POST_ASSERT(offsetof(PostPlugin, table_size) == 20, "PostPlugin.table_size");
POST_ASSERT(offsetof(PostPlugin, layout) == 24, "PostPlugin.layout");
POST_ASSERT(offsetof(PostPlugin, name) == 32, "PostPlugin.name");
POST_ASSERT(offsetof(PostPlugin, version) == 48, "PostPlugin.version");
POST_ASSERT(offsetof(PostPlugin, describe) == 64, "PostPlugin.describe");
POST_ASSERT(offsetof(PostPlugin, loaded) == 72, "PostPlugin.loaded");
POST_ASSERT(offsetof(PostPlugin, dialect) == 80, "PostPlugin.dialect");
POST_ASSERT(offsetof(PostPlugin, model) == 88, "PostPlugin.model");
POST_ASSERT(offsetof(PostPlugin, about) == 96, "PostPlugin.about");
POST_ASSERT(sizeof(PostDialect) == 56 && POST_ALIGN(PostDialect) == 8, "PostDialect");
POST_ASSERT(offsetof(PostDialect, open) == 0, "PostDialect.open");
POST_ASSERT(offsetof(PostDialect, format) == 8, "PostDialect.format");
POST_ASSERT(offsetof(PostDialect, write) == 16, "PostDialect.write");
POST_ASSERT(offsetof(PostDialect, last_error) == 24, "PostDialect.last_error");
POST_ASSERT(offsetof(PostDialect, close) == 32, "PostDialect.close");
POST_ASSERT(offsetof(PostDialect, vocabulary) == 40, "PostDialect.vocabulary");
POST_ASSERT(offsetof(PostDialect, relies_on) == 48, "PostDialect.relies_on");
POST_ASSERT(sizeof(PostModel) == 40 && POST_ALIGN(PostModel) == 8, "PostModel");
POST_ASSERT(offsetof(PostModel, open) == 0, "PostModel.open");
POST_ASSERT(offsetof(PostModel, fit) == 8, "PostModel.fit");
POST_ASSERT(offsetof(PostModel, value) == 16, "PostModel.value");
POST_ASSERT(offsetof(PostModel, last_error) == 24, "PostModel.last_error");
POST_ASSERT(offsetof(PostModel, close) == 32, "PostModel.close");
/* generated: end */

#endif
