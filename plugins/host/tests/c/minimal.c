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
    size_t words_len;
    int decimals;
    char error[128];
} Context;

static void put(const PostSink *sink, const char *text) {
    sink->write(sink->ctx, (const uint8_t *)text, strlen(text));
}

static void describe(void *host, PostEmit emit) {
    PostOption option = {0};
    option.key = (PostText)POST_TEXT("decimals");
    option.help = (PostText)POST_TEXT("Of all words.");
    option.kind = POST_OPTION_INTEGER;
    option.min = 1;
    option.max = 6;
    option.default_value.kind = POST_OPTION_INTEGER;
    option.default_value.integer = 3;
    emit(host, &option);
}

static void *open_(const PostSetup *setup, const PostSink *error) {
    if (setup->tcp) {
        put(error, "this control has no TCP");
        return NULL;
    }
    Context *c = calloc(1, sizeof *c);
    if (c == NULL) {
        put(error, "out of memory");
        return NULL;
    }
    c->words_len = setup->words_len;
    for (size_t i = 0; i < setup->words_len; i++)
        snprintf(c->names[i], sizeof c->names[i], "%.*s", (int)setup->words[i].name.len,
                 (const char *)setup->words[i].name.ptr);
    c->decimals = (int)setup->options[0].value.integer;
    return c;
}

static int32_t format(void *ctx, PostFormat *f) {
    Context *c = ctx;
    memset(f->words, c->decimals, c->words_len);
    f->words_len = (uint32_t)c->words_len;
    f->feed = 1;
    f->inverse_time = -1;
    memcpy(f->extension, "tap", 3);
    return 0;
}

/* `feed` and `words`: where they stand among the event's numbers; -1 if there is no feed. */
static int move_(Context *c, const PostEvent *e, int feed, size_t words, char *line, size_t size, int *len) {
    double code = feed < 0 ? POST_FEED_NONE : e->numbers[feed];
    if (code > POST_FEED_PER_MINUTE) {
        snprintf(c->error, sizeof c->error, "it knows feeds a minute alone");
        return 0;
    }
    int n = snprintf(line, size, "%s", code == POST_FEED_NONE ? "G0" : "G1");
    for (size_t w = 0; w < (size_t)e->numbers[words] && n < 400; w++)
        n += snprintf(line + n, size - n, " %s%.*f", c->names[w], c->decimals, e->numbers[words + 1 + w]);
    if (code != POST_FEED_NONE)
        n += snprintf(line + n, size - n, " F%.1f", e->numbers[feed + 1]);
    *len = n + snprintf(line + n, size - n, "\n");
    return 1;
}

static size_t write_(void *ctx, const PostEvent *events, size_t n, const PostSink *out, uint64_t *ends) {
    Context *c = ctx;
    uint64_t end = 0;
    for (size_t i = 0; i < n; i++) {
        const PostEvent *e = &events[i];
        char line[512];
        int len = 0;
        switch (e->kind) {
        case POST_EVENT_START:
            len = snprintf(line, sizeof line, "G21 G90 G94\n");
            break;
        case POST_EVENT_POSITION:
            if (!move_(c, e, POST_POSITION_FEED, POST_POSITION_WORDS, line, sizeof line, &len))
                return i;
            break;
        case POST_EVENT_RAPID:
            if (!move_(c, e, -1, POST_RAPID_WORDS, line, sizeof line, &len))
                return i;
            break;
        case POST_EVENT_LINEAR:
            if (!move_(c, e, POST_LINEAR_FEED, POST_LINEAR_WORDS, line, sizeof line, &len))
                return i;
            break;
        case POST_EVENT_END:
            len = snprintf(line, sizeof line, "M30\n");
            break;
        default: /* never drop what is not known */
            snprintf(c->error, sizeof c->error, "it has no words for kind %u", e->kind);
            return i;
        }
        out->write(out->ctx, (const uint8_t *)line, (size_t)len);
        end += (uint64_t)len;
        ends[i] = end;
    }
    return n;
}

static void last_error(void *ctx, const PostSink *out) {
    put(out, ((Context *)ctx)->error);
}

static void close_(void *ctx) {
    free(ctx);
}

static const PostDialect dialect = {open_, format, write_, last_error, close_};

POST_EXPORT const PostPlugin post_plugin_minimal;
const PostPlugin post_plugin_minimal = {
    POST_HEAD(POST_KIND_DIALECT, PostDialect),
    POST_TEXT("minimal"),
    POST_TEXT("1.0"),
    describe,
    NULL,
    &dialect,
    NULL,
};
