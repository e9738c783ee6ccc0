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

/* `kind` is POST_OPTION_FLAG (`integer` is 0 or 1), _INTEGER, _NUMBER or _TEXT (also for a choice). */
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

/* `rotary`: degrees. `depth`: the linear axis along the spindle at all axes zero. */
typedef struct {
    PostText name;
    uint32_t rotary;
    uint32_t depth;
} PostAxisWord;

/* `tcp`: 1 if the control keeps the tip on its path. `options`: every declared one has a value. */
typedef struct {
    PostText program;
    PostText machine;
    uint32_t units;
    uint32_t tcp;
    const PostAxisWord *words;
    size_t words_len;
    const PostPair *options;
    size_t options_len;
} PostSetup;

/* One step of a program; a field that its kind does not use is 0.
 *
 *   kind                        fields
 *   POST_EVENT_START            -
 *   POST_EVENT_COMMENT          text; any characters: make it safe
 *   POST_EVENT_LITERAL          text; write it letter for letter
 *   POST_EVENT_WORD             text; write it letter for letter; nothing in force changes (a clamp)
 *   POST_EVENT_TOOL_CHANGE      number, register (of the length), text (its name, may be empty)
 *   POST_EVENT_PRESELECT        number
 *   POST_EVENT_SPINDLE          code POST_SPINDLE_, value: revolutions a minute
 *   POST_EVENT_COOLANT          code POST_COOLANT_
 *   POST_EVENT_COMPENSATE       code POST_COMPENSATE_, register; with the next move
 *   POST_EVENT_POSITION         words, code POST_FEED_ (NONE: rapid), value; puts length or TCP in force,
 *                               rotary axes first, then the plane, then the depth
 *   POST_EVENT_RELEASE          cancels what POSITION put in force
 *   POST_EVENT_RAPID            words
 *   POST_EVENT_LINEAR           words, code POST_FEED_, value
 *   POST_EVENT_DWELL            value: seconds
 *   POST_EVENT_STOP, _OPTIONAL_STOP, _HOME, _END
 *
 * `words` holds one number for each word of the setup, rounded to the decimals of the format. `line` is
 * that of the CL file. */
typedef struct {
    uint32_t kind;
    uint32_t code;
    uint64_t line;
    uint32_t number;
    uint32_t register_; /* `register` is a keyword */
    double value;
    const double *words;
    size_t words_len;
    PostText text;
} PostEvent;

/* Comes filled with zeros. Decimals are at most 9; `inverse_time` is -1 if there is no G93; `words_len` is
 * that of the setup; `extension` is padded with zeros. */
typedef struct {
    uint8_t words[32];
    uint32_t feed;
    int32_t inverse_time;
    uint32_t feed_per_revolution;
    uint32_t words_len;
    uint8_t extension[16];
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
typedef void (*PostDeviationFn)(void *host, size_t n, const double *ts, PostDeviation *out);

/* The functions of a dialect; none may be null. */
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
#define POST_LAYOUT 0x14d7bbec8762b65bu
#define POST_ABI 1u
#define POST_KIND_DIALECT 1u
#define POST_KIND_MODEL 2u
#define POST_MAX_WORDS 32u
#define POST_OPTION_FLAG 1u
#define POST_OPTION_INTEGER 2u
#define POST_OPTION_NUMBER 3u
#define POST_OPTION_TEXT 4u
#define POST_OPTION_CHOICE 5u
#define POST_UNITS_MILLIMETRE 1u
#define POST_UNITS_INCH 2u
#define POST_EVENT_START 1u
#define POST_EVENT_COMMENT 2u
#define POST_EVENT_LITERAL 3u
#define POST_EVENT_TOOL_CHANGE 4u
#define POST_EVENT_PRESELECT 5u
#define POST_EVENT_SPINDLE 6u
#define POST_EVENT_COOLANT 7u
#define POST_EVENT_COMPENSATE 8u
#define POST_EVENT_POSITION 9u
#define POST_EVENT_RELEASE 10u
#define POST_EVENT_RAPID 11u
#define POST_EVENT_LINEAR 12u
#define POST_EVENT_DWELL 13u
#define POST_EVENT_STOP 14u
#define POST_EVENT_OPTIONAL_STOP 15u
#define POST_EVENT_HOME 16u
#define POST_EVENT_END 17u
#define POST_EVENT_WORD 18u
#define POST_FEED_NONE 0u
#define POST_FEED_PER_MINUTE 1u
#define POST_FEED_INVERSE_TIME 2u
#define POST_FEED_PER_REVOLUTION 3u
#define POST_SPINDLE_OFF 0u
#define POST_SPINDLE_CLOCKWISE 1u
#define POST_SPINDLE_COUNTER_CLOCKWISE 2u
#define POST_SPINDLE_ORIENT 3u
#define POST_COOLANT_OFF 0u
#define POST_COOLANT_FLOOD 1u
#define POST_COOLANT_MIST 2u
#define POST_COOLANT_THROUGH 3u
#define POST_COOLANT_AIR 4u
#define POST_COMPENSATE_OFF 0u
#define POST_COMPENSATE_LEFT 1u
#define POST_COMPENSATE_RIGHT 2u
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
POST_ASSERT(sizeof(PostAxisWord) == 24 && POST_ALIGN(PostAxisWord) == 8, "PostAxisWord");
POST_ASSERT(offsetof(PostAxisWord, name) == 0, "PostAxisWord.name");
POST_ASSERT(offsetof(PostAxisWord, rotary) == 16, "PostAxisWord.rotary");
POST_ASSERT(offsetof(PostAxisWord, depth) == 20, "PostAxisWord.depth");
POST_ASSERT(sizeof(PostSetup) == 72 && POST_ALIGN(PostSetup) == 8, "PostSetup");
POST_ASSERT(offsetof(PostSetup, program) == 0, "PostSetup.program");
POST_ASSERT(offsetof(PostSetup, machine) == 16, "PostSetup.machine");
POST_ASSERT(offsetof(PostSetup, units) == 32, "PostSetup.units");
POST_ASSERT(offsetof(PostSetup, tcp) == 36, "PostSetup.tcp");
POST_ASSERT(offsetof(PostSetup, words) == 40, "PostSetup.words");
POST_ASSERT(offsetof(PostSetup, words_len) == 48, "PostSetup.words_len");
POST_ASSERT(offsetof(PostSetup, options) == 56, "PostSetup.options");
POST_ASSERT(offsetof(PostSetup, options_len) == 64, "PostSetup.options_len");
POST_ASSERT(sizeof(PostEvent) == 64 && POST_ALIGN(PostEvent) == 8, "PostEvent");
POST_ASSERT(offsetof(PostEvent, kind) == 0, "PostEvent.kind");
POST_ASSERT(offsetof(PostEvent, code) == 4, "PostEvent.code");
POST_ASSERT(offsetof(PostEvent, line) == 8, "PostEvent.line");
POST_ASSERT(offsetof(PostEvent, number) == 16, "PostEvent.number");
POST_ASSERT(offsetof(PostEvent, register_) == 20, "PostEvent.register_");
POST_ASSERT(offsetof(PostEvent, value) == 24, "PostEvent.value");
POST_ASSERT(offsetof(PostEvent, words) == 32, "PostEvent.words");
POST_ASSERT(offsetof(PostEvent, words_len) == 40, "PostEvent.words_len");
POST_ASSERT(offsetof(PostEvent, text) == 48, "PostEvent.text");
POST_ASSERT(sizeof(PostFormat) == 64 && POST_ALIGN(PostFormat) == 4, "PostFormat");
POST_ASSERT(offsetof(PostFormat, words) == 0, "PostFormat.words");
POST_ASSERT(offsetof(PostFormat, feed) == 32, "PostFormat.feed");
POST_ASSERT(offsetof(PostFormat, inverse_time) == 36, "PostFormat.inverse_time");
POST_ASSERT(offsetof(PostFormat, feed_per_revolution) == 40, "PostFormat.feed_per_revolution");
POST_ASSERT(offsetof(PostFormat, words_len) == 44, "PostFormat.words_len");
POST_ASSERT(offsetof(PostFormat, extension) == 48, "PostFormat.extension");
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
POST_ASSERT(sizeof(PostPlugin) == 96 && POST_ALIGN(PostPlugin) == 8, "PostPlugin");
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
POST_ASSERT(sizeof(PostDialect) == 40 && POST_ALIGN(PostDialect) == 8, "PostDialect");
POST_ASSERT(offsetof(PostDialect, open) == 0, "PostDialect.open");
POST_ASSERT(offsetof(PostDialect, format) == 8, "PostDialect.format");
POST_ASSERT(offsetof(PostDialect, write) == 16, "PostDialect.write");
POST_ASSERT(offsetof(PostDialect, last_error) == 24, "PostDialect.last_error");
POST_ASSERT(offsetof(PostDialect, close) == 32, "PostDialect.close");
POST_ASSERT(sizeof(PostModel) == 40 && POST_ALIGN(PostModel) == 8, "PostModel");
POST_ASSERT(offsetof(PostModel, open) == 0, "PostModel.open");
POST_ASSERT(offsetof(PostModel, fit) == 8, "PostModel.fit");
POST_ASSERT(offsetof(PostModel, value) == 16, "PostModel.value");
POST_ASSERT(offsetof(PostModel, last_error) == 24, "PostModel.last_error");
POST_ASSERT(offsetof(PostModel, close) == 32, "PostModel.close");
/* generated: end */

#endif
