/* A dialect with one fault, chosen by -DFAULT_…; the host must refuse each. */
#include "post_plugin.h"

#include <string.h>

static int context;

static void *open_(const PostSetup *setup, const PostSink *error) {
    (void)setup, (void)error;
#ifdef FAULT_OPEN
    return NULL;
#endif
    return &context;
}

static int32_t format(void *ctx, PostFormat *f) {
    (void)ctx;
    f->words_len = 1;
    f->inverse_time = -1;
#ifdef FAULT_WORDS
    f->words_len = 4000000000u;
#endif
#ifdef FAULT_DECIMALS
    f->words[0] = 200;
#endif
#ifdef FAULT_EXTENSION
    memcpy(f->extension, "../x", 4);
#endif
    return 0;
}

static size_t write_(void *ctx, const PostEvent *events, size_t n, const PostSink *out, uint64_t *ends) {
    (void)ctx, (void)events;
    const char *text = "G0 X1\n";
#ifdef FAULT_NAN
    text = "G0 X-nan\n";
#endif
#ifdef FAULT_UTF8
    text = "G0 X\xff\n";
#endif
#ifdef FAULT_CONTROL
    text = "G0\x1b X1\n";
#endif
#ifdef FAULT_LINE
    text = "G0 X1";
#endif
    uint64_t end = 0;
    for (size_t i = 0; i < n; i++) {
        out->write(out->ctx, (const uint8_t *)text, strlen(text));
        end += strlen(text);
        ends[i] = end;
    }
#ifdef FAULT_ENDS
    ends[n - 1] = 1u << 30;
#endif
#ifdef FAULT_BACK
    ends[0] = end;
    ends[n - 1] = 0;
#endif
#ifdef FAULT_NO_ENDS
    ends[0] = 0, ends[n - 1] = 0;
#endif
#ifdef FAULT_COUNT
    return n + 1;
#endif
    return n;
}

static void last_error(void *ctx, const PostSink *out) {
    (void)ctx, (void)out;
}

static void close_(void *ctx) {
    (void)ctx;
}

#ifdef FAULT_DEFAULT
static void describe(void *host, PostEmit emit) {
    PostOption option = {0};
    option.key = (PostText)POST_TEXT("speed");
    option.kind = POST_OPTION_NUMBER;
    option.max = 1;
    option.default_value.kind = POST_OPTION_NUMBER;
    option.default_value.number = 7;
    emit(host, &option);
}
#else
#define describe NULL
#endif

#ifdef FAULT_NULL_WRITE
#define write_ NULL
#endif

static const PostDialect dialect = {open_, format, write_, last_error, close_};

#ifndef FAULT_SYMBOL
POST_EXPORT const PostPlugin post_plugin_hostile;
const PostPlugin post_plugin_hostile = {
#ifdef FAULT_MAGIC
    POST_MAGIC + 1,
#else
    POST_MAGIC,
#endif
#ifdef FAULT_ABI
    POST_ABI + 8,
#else
    POST_ABI,
#endif
#ifdef FAULT_KIND
    77,
#else
    POST_KIND_DIALECT,
#endif
#ifdef FAULT_SIZE
    4000000000u,
#else
    sizeof(PostPlugin),
#endif
#ifdef FAULT_TABLE_SIZE
    sizeof(PostDialect) - 8,
#else
    sizeof(PostDialect),
#endif
#ifdef FAULT_LAYOUT
    POST_LAYOUT ^ 1,
#else
    POST_LAYOUT,
#endif
#ifdef FAULT_NULL_NAME
    {NULL, 7},
#elif defined(FAULT_NAME)
    POST_TEXT("friendly"),
#else
    POST_TEXT("hostile"),
#endif
    POST_TEXT("1.0"),
    describe,
    NULL,
#ifdef FAULT_NULL_TABLE
    NULL,
#else
    &dialect,
#endif
    NULL,
};
#endif
