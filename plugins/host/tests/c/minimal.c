/* The smallest dialect in C: absolute moves, nothing modal.
 *
 *     cc -O2 -shared -fPIC -I plugins/api/include minimal.c -o libpost_minimal.so
 */
#include "post_plugin.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
    char names[32][8];
    uint32_t rotary[32];
    uint32_t depth[32];
    size_t words_len;
    int decimals;
    int inch;
    int length_register;
    char error[128];
} Context;

static void describe(void *host, PostEmit emit) {
    PostOption decimals = post_integer_option("decimals", "Of all words.", 1, 6, 3);
    emit(host, &decimals);
}

static void *open_(const PostSetup *setup, const PostSink *error) {
    if (setup->tcp) {
        post_put(error, "this control has no TCP");
        return NULL;
    }
    Context *c = calloc(1, sizeof *c);
    if (c == NULL) {
        post_put(error, "out of memory");
        return NULL;
    }
    c->words_len = setup->words_len;
    c->inch = setup->units == POST_UNITS_INCH;
    for (size_t i = 0; i < setup->words_len; i++) {
        const PostAxisWord *word = &setup->words[i];
        /* X1 at 450 would be X at 1450 */
        if (word->name.len != 1 || strchr("XYZABCUVW", *(const char *)word->name.ptr) == NULL) {
            char refusal[64];
            snprintf(refusal, sizeof refusal, "axis %.*s: this control has no such axis", (int)word->name.len,
                     (const char *)word->name.ptr);
            post_put(error, refusal);
            free(c);
            return NULL;
        }
        snprintf(c->names[i], sizeof c->names[i], "%c", *(const char *)word->name.ptr);
        c->rotary[i] = word->rotary;
        c->depth[i] = word->depth;
    }
    c->decimals = (int)post_option(setup->options, setup->options_len, "decimals")->integer;
    return c;
}

static int32_t format(void *ctx, PostFormat *f) {
    Context *c = ctx;
    memset(f->words, c->decimals, c->words_len);
    f->words_len = (uint32_t)c->words_len;
    f->feed = 1;
    f->inverse_time = -1;
    memcpy(f->extension, "nc", 2);
    return 0;
}

/* Of all words, of the rotary ones, of the linear ones but the depth, of the depth. */
enum Group { ALL, ROTARY, PLANE, DEPTH };

/* A block with the words of a group; none if it has no words. `feed` and `words`: where they stand among the event's
 * numbers; -1 if there is no feed. Returns its length, negative if it cannot be written. */
static int move_(Context *c, const PostEvent *e, enum Group group, int feed, size_t words, char *line, size_t size) {
    size_t count;
    const double *word = post_list(e, words, &count);
    if (count != c->words_len) {
        snprintf(c->error, sizeof c->error, "kind %u has %zu words, the setup %zu", e->kind, count, c->words_len);
        return -1;
    }
    double code = feed < 0 ? POST_FEED_NONE : post_number(e, (size_t)feed);
    if (!(code <= POST_FEED_PER_MINUTE)) {
        snprintf(c->error, sizeof c->error, "it knows feeds a minute alone");
        return -1;
    }
    int n = snprintf(line, size, "%s", code == POST_FEED_NONE ? "G0" : "G1");
    if (group == DEPTH)
        n += snprintf(line + n, size - n, " G43 H%d", c->length_register);
    int start = n;
    for (size_t w = 0; w < count && n < 400; w++) {
        enum Group own = c->rotary[w] ? ROTARY : c->depth[w] ? DEPTH : PLANE;
        if (group == ALL || group == own)
            n += snprintf(line + n, size - n, " %s%.*f", c->names[w], c->decimals, word[w]);
    }
    if (n == start)
        return 0;
    if (code != POST_FEED_NONE)
        n += snprintf(line + n, size - n, " F%.1f", post_number(e, (size_t)feed + 1));
    return n + snprintf(line + n, size - n, "\n");
}

/* The plane first, then the depth with the tool's length. */
static int position(Context *c, const PostEvent *e, char *text, size_t size) {
    if (c->length_register == 0) {
        snprintf(c->error, sizeof c->error, "no tool was loaded, so its length is not known");
        return -1;
    }
    int n = move_(c, e, PLANE, -1, POST_AT_POSITION_WORDS, text, size);
    int last = move_(c, e, DEPTH, POST_AT_POSITION_FEED, POST_AT_POSITION_WORDS, text + n, size - n);
    return last < 0 ? last : n + last;
}

/* Axes to positions of the machine; `axes` and `words`: where they stand among the event's numbers. */
static int machine(Context *c, const PostEvent *e, size_t axes, size_t words, char *text, size_t size) {
    unsigned which = (unsigned)post_number(e, axes);
    size_t count;
    const double *word = post_list(e, words, &count);
    int n = snprintf(text, size, "G53 G0");
    for (size_t w = 0; w < count && w < c->words_len; w++)
        if (which >> w & 1)
            n += snprintf(text + n, size - n, " %s%.*f", c->names[w], c->decimals, word[w]);
    return n + snprintf(text + n, size - n, "\n");
}

/* The text of the event in a line, between these. A remark is cut, and what is no plain letter in it becomes a question
 * mark: an operator reads it, no control. */
static int line_of(Context *c, const PostEvent *e, const char *front, const char *behind, char *text, size_t size) {
    PostText own = post_text(e, 0);
    size_t length = own.len;
    if (*front && length > 80)
        length = 80;
    if (length > 200) {
        snprintf(c->error, sizeof c->error, "a line has 200 characters at most");
        return -1;
    }
    int n = snprintf(text, size, "%s", front);
    for (size_t i = 0; i < length; i++) {
        char letter = ((const char *)own.ptr)[i];
        int odd = letter < ' ' || letter > '~' || strchr("()%", letter) != NULL;
        text[n++] = (char)(*front && odd ? '?' : letter);
    }
    return n + snprintf(text + n, size - n, "%s\n", behind);
}

/* The text of one event; its length, negative if it cannot be written. */
static int text_of(Context *c, const PostEvent *e, char *text, size_t size) {
    switch (e->kind) {
    case POST_EVENT_START:
        return snprintf(text, size, "%s\nG17 G40 G80 G90 G94\n", c->inch ? "G20" : "G21");
    case POST_EVENT_COMMENT:
        return line_of(c, e, "(", ")", text, size);
    case POST_EVENT_LITERAL:
    case POST_EVENT_WORD:
        return line_of(c, e, "", "", text, size);
    case POST_EVENT_TOOL_CHANGE:
        c->length_register = (int)post_number(e, POST_AT_TOOL_CHANGE_REGISTER);
        return snprintf(text, size, "T%.0f M6\n", post_number(e, POST_AT_TOOL_CHANGE_NUMBER));
    case POST_EVENT_SPINDLE: {
        double how = post_number(e, POST_AT_SPINDLE_SPINDLE);
        if (how == POST_SPINDLE_OFF)
            return snprintf(text, size, "M5\n");
        if (how == POST_SPINDLE_ORIENT)
            break;
        const char *sense = how == POST_SPINDLE_CLOCKWISE ? "M3" : "M4";
        return snprintf(text, size, "S%.0f %s\n", post_number(e, POST_AT_SPINDLE_SPINDLE + 1), sense);
    }
    case POST_EVENT_COOLANT: {
        double kind = post_number(e, POST_AT_COOLANT_COOLANT);
        if (kind > POST_COOLANT_FLOOD)
            break;
        return snprintf(text, size, kind == POST_COOLANT_OFF ? "M9\n" : "M8\n");
    }
    case POST_EVENT_POSITION:
        return position(c, e, text, size);
    case POST_EVENT_RAPID:
        return move_(c, e, ALL, -1, POST_AT_RAPID_WORDS, text, size);
    case POST_EVENT_LINEAR:
        return move_(c, e, ALL, POST_AT_LINEAR_FEED, POST_AT_LINEAR_WORDS, text, size);
    case POST_EVENT_DWELL:
        return snprintf(text, size, "G4 P%.0f\n", post_number(e, POST_AT_DWELL_SECONDS) * 1000);
    case POST_EVENT_STOP:
        return snprintf(text, size, "M0\n");
    case POST_EVENT_OPTIONAL_STOP:
        return snprintf(text, size, "M1\n");
    case POST_EVENT_TURN:
        return move_(c, e, ROTARY, -1, POST_AT_TURN_WORDS, text, size);
    case POST_EVENT_RETRACT: { /* up, and only there the length away */
        int n = machine(c, e, POST_AT_RETRACT_AXES, POST_AT_RETRACT_WORDS, text, size);
        return n + snprintf(text + n, size - n, "G49\n");
    }
    case POST_EVENT_PARK:
        return machine(c, e, POST_AT_PARK_AXES, POST_AT_PARK_WORDS, text, size);
    case POST_EVENT_END:
        return snprintf(text, size, "M30\n");
    }
    /* never drop what is not known */
    snprintf(c->error, sizeof c->error, "it has no words for kind %u", e->kind);
    return -1;
}

static size_t write_(void *ctx, const PostEvent *events, size_t n, const PostSink *out, uint64_t *ends) {
    Context *c = ctx;
    uint64_t end = 0;
    for (size_t i = 0; i < n; i++) {
        char text[1024];
        int len = text_of(c, &events[i], text, sizeof text);
        if (len < 0)
            return i;
        out->write(out->ctx, (const uint8_t *)text, (size_t)len);
        end += (uint64_t)len;
        ends[i] = end;
    }
    return n;
}

static void last_error(void *ctx, const PostSink *out) {
    post_put(out, ((Context *)ctx)->error);
}

static void close_(void *ctx) {
    free(ctx);
}

static const struct {
    const char *word;
    uint32_t meaning;
} words[] = {
    {"(", POST_MEANING_REMARK_OPEN},     {")", POST_MEANING_REMARK_CLOSE},
    {"G21", POST_MEANING_MILLIMETRE},    {"G20", POST_MEANING_INCH},
    {"G17", POST_MEANING_PLANE_XY},      {"G40", POST_MEANING_COMPENSATION_OFF},
    {"G80", POST_MEANING_CYCLE_OFF},     {"G90", POST_MEANING_ABSOLUTE},
    {"G94", POST_MEANING_FEED_PER_MINUTE}, {"G0", POST_MEANING_RAPID},
    {"G1", POST_MEANING_LINEAR},         {"F", POST_MEANING_FEED},
    {"G53", POST_MEANING_MACHINE_COORDINATES}, {"G43", POST_MEANING_LENGTH_ON},
    {"H", POST_MEANING_LENGTH_REGISTER}, {"G49", POST_MEANING_LENGTH_OFF},
    {"T", POST_MEANING_TOOL},            {"M6", POST_MEANING_TOOL_CHANGE},
    {"S", POST_MEANING_SPINDLE_SPEED},   {"M3", POST_MEANING_SPINDLE_CLOCKWISE},
    {"M4", POST_MEANING_SPINDLE_COUNTER_CLOCKWISE}, {"M5", POST_MEANING_SPINDLE_OFF},
    {"M8", POST_MEANING_COOLANT_ON},     {"M9", POST_MEANING_COOLANT_OFF},
    {"G4", POST_MEANING_DWELL},          {"G4 P", POST_MEANING_DWELL_MILLISECONDS},
    {"M0", POST_MEANING_STOP},
    {"M1", POST_MEANING_OPTIONAL_STOP},  {"M30", POST_MEANING_END},
};

/* What a program needs at the control: the setup sheet has it. */
static int32_t relies_on(void *ctx, const PostSink *out) {
    (void)ctx;
    static const char sentence[] = "G53 counts from the machine's zero";
    out->write(out->ctx, (const uint8_t *)sentence, sizeof sentence - 1);
    return 0;
}

/* What the words mean, so that a program can be read back. */
static int32_t vocabulary(void *ctx, void *host, PostEmitWord emit) {
    (void)ctx;
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        emit(host, words[i].meaning, (const uint8_t *)words[i].word, strlen(words[i].word));
    return 0;
}

static const PostDialect dialect = {open_, format, write_, last_error, close_, vocabulary, relies_on};

POST_EXPORT const PostPlugin post_plugin_minimal;
const PostPlugin post_plugin_minimal = {
    POST_HEAD(POST_KIND_DIALECT, PostDialect),
    POST_TEXT("minimal"),
    POST_TEXT("1.0"),
    describe,
    NULL,
    &dialect,
    NULL,
    POST_TEXT("A control for nothing but moves."),
};
