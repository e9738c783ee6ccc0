/* A dialect with one fault, chosen by -DFAULT_…; the host must refuse each, or undo it. */
#define _GNU_SOURCE
#include "post_plugin.h"

#include <fenv.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int context;
static uint32_t words;

static void *ends_it(void *nothing) {
    exit(0);
    return nothing;
}

static void *goes_on(void *nothing) {
    for (;;)
        usleep(1000);
    return nothing;
}

static volatile int sum;

static int deep(volatile char *above) {
    volatile char frame[4096];
    frame[0] = *above;
    return deep(frame) + frame[0];
}

/* What only a process of its own survives; `at` is the event. */
static void dies(size_t at) {
    (void)at;
#if defined FAULT_LATER
    if (at < 2)
        return;
#endif
#if defined FAULT_SEGV || defined FAULT_LATER
    *(volatile int *)8 = 1;
#endif
#ifdef FAULT_ABORT
    abort();
#endif
#ifdef FAULT_DIVIDES
    raise(SIGFPE);
#endif
#ifdef FAULT_DEEP
    sum = deep((volatile char *)&sum);
#endif
#ifdef FAULT_EXITS_AT_ONCE
    _exit(0);
#endif
#ifdef FAULT_LOOPS
    for (;;)
        sum++;
#endif
#ifdef FAULT_LEAVES_GROUP
    /* into that of the command, which is the user's */
    if (setpgid(0, getpgid(getppid())))
        abort();
    printf("left\n");
    fflush(stdout);
    for (;;)
        sum++;
#endif
#ifdef FAULT_SLEEPS
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, NULL);
    for (;;)
        pause();
#endif
#ifdef FAULT_EATS
    for (;;) {
        char *block = malloc(1 << 26);
        memset(block, 1, 1 << 26);
    }
#endif
#ifdef FAULT_FORKS
    if (at == 0 && fork() < 0)
        abort();
#endif
#ifdef FAULT_FORKS_AGAIN
    if (fork() < 0)
        return;
#endif
#ifdef FAULT_FORKS_AND_DIES
    if (fork() == 0)
        for (;;)
            pause();
    abort();
#endif
#ifdef FAULT_CLOSES
    for (int file = 3; file < 1024; file++)
        close(file);
#endif
#ifdef FAULT_CLOSES_ALL
    for (int file = 0; file < 1024; file++)
        close(file);
#endif
#ifdef FAULT_SCRIBBLES
    for (int file = 3; file < 64; file++)
        if (write(file, "ten bytes.", 10) < 0)
            continue;
#endif
#ifdef FAULT_DRIPS
    /* a long answer, a byte at a time */
    uint64_t length = 1u << 25;
    for (int file = 3; file < 64; file++)
        if (write(file, &length, sizeof length) < 0)
            continue;
    for (;;) {
        for (int file = 3; file < 64; file++)
            if (write(file, "x", 1) < 0)
                continue;
        usleep(20000);
    }
#endif
#ifdef FAULT_KILLS_ITSELF
    raise(SIGKILL);
#endif
}

static void ends_it_well(void) {
    _exit(0);
}

/* What the process is left in. */
static void disturb(void) {
    fesetround(FE_UPWARD);
    if (chdir("/"))
        abort();
}

__attribute__((constructor)) static void constructor(void) {
#ifdef FAULT_EXIT_LOAD
    exit(0);
#endif
#ifdef FAULT_ABORT_LOAD
    abort();
#endif
#ifdef FAULT_DISTURB
    disturb();
#endif
#ifdef FAULT_OPENS_ALL
    while (dup(0) >= 0)
        ;
#endif
#ifdef FAULT_LATE_EXIT
    atexit(ends_it_well);
#endif
#ifdef FAULT_SELF
    /* another file takes its name */
    char other[4096];
    snprintf(other, sizeof other, "%s.other", getenv("HOSTILE_PATH"));
    if (rename(other, getenv("HOSTILE_PATH")))
        abort();
#endif
}

static void *open_(const PostSetup *setup, const PostSink *error) {
    (void)error;
    words = (uint32_t)setup->words_len;
#ifdef FAULT_OPEN_LOOPS
    for (;;)
        sum++;
#endif
#ifdef FAULT_OPEN
    return NULL;
#endif
#ifdef FAULT_EXIT_OPEN
    exit(0);
#endif
#ifdef FAULT_QUICK_EXIT
    quick_exit(0);
#endif
#ifdef FAULT_PRINTS
    printf("G0 Z-500\n");
#endif
#ifdef FAULT_FORGES
    fprintf(stderr, "error[travel]: X is \033[2Jpast its travel\n  --> part.nc:1\n");
#endif
#ifdef FAULT_PRINTS_BIT
    fprintf(stderr, "a line that does not end");
#endif
#ifdef FAULT_PRINTS_ON
    for (int line = 0; line < 300000; line++)
        fprintf(stderr, "%d is said\n", line);
#endif
#ifdef FAULT_LEAVES_A_PRINTER
    if (!fork()) {
        setsid();
        for (int line = 0; line < 600; line++) {
            dprintf(2, "still here\n");
            usleep(100000);
        }
        _exit(0);
    }
#endif
#ifdef FAULT_EXIT_THREAD
    pthread_t thread;
    pthread_create(&thread, NULL, ends_it, NULL);
    pthread_join(thread, NULL);
#endif
#ifdef FAULT_THREAD_GOES_ON
    pthread_t other;
    pthread_create(&other, NULL, goes_on, NULL);
#endif
    return &context;
}

static int32_t format(void *ctx, PostFormat *f) {
    (void)ctx;
    f->words_len = words;
    memset(f->words, 3, words);
    f->inverse_time = -1;
#ifdef FAULT_FORMAT_LOOPS
    for (;;)
        sum++;
#endif
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
    size_t length = 0;
#ifdef FAULT_DISTURB
    disturb();
#endif
#ifdef FAULT_EXIT
    exit(0);
#endif
#ifdef FAULT_CR
    text = "(x)\rG0 Z-50\n";
#endif
#ifdef FAULT_CR_CR
    text = "G0 X1\r\r\n";
#endif
#ifdef FAULT_LONG_LINE
    static char line[16386];
    text = memset(line, ' ', sizeof line - 1);
    line[sizeof line - 2] = '\n';
#endif
#ifdef FAULT_LONGER_LINE
    static char line[16387];
    text = memset(line, ' ', sizeof line - 1);
    line[sizeof line - 2] = '\n';
#endif
#ifdef FAULT_CRLF
    text = "G0\tX1\r\n";
#endif
#ifdef FAULT_NEL
    text = "(x)\xc2\x85G0 Z-50\n";
#endif
#ifdef FAULT_SEPARATOR
    text = "(x)\xe2\x80\xa8G0 Z-50\n";
#endif
#ifdef FAULT_FEED
    text = "(x)\fG0 Z-50\n";
#endif
#ifdef FAULT_BACKWARD
    text = "(\xe2\x80\xae)G0 Z-50\n";
#endif
#ifdef FAULT_NUL
    text = "G0\0X1\n";
    length = 6;
#endif
#ifdef FAULT_NULL_TEXT
    out->write(out->ctx, NULL, 100);
#endif
#ifdef FAULT_HUGE_TEXT
    out->write(out->ctx, (const uint8_t *)text, SIZE_MAX / 4);
#endif
#ifdef FAULT_FLOOD
    static char flood[1 << 20];
    for (long i = 0; i < 100000; i++)
        out->write(out->ctx, (const uint8_t *)flood, sizeof flood);
#endif
#if defined FAULT_MESSAGE || defined FAULT_SENTENCE_LOOPS
    return 0;
#endif
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
        dies(i);
        size_t len = length ? length : strlen(text);
        out->write(out->ctx, (const uint8_t *)text, len);
        end += len;
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
#ifdef FAULT_SENTENCE_LOOPS
    for (;;)
        sum++;
#endif
#ifdef FAULT_MESSAGE
    const char *text = "\033[2J\033]0;owned\007 all\r\nis well";
    out->write(out->ctx, (const uint8_t *)text, strlen(text));
    for (int i = 0; i < 100000; i++)
        out->write(out->ctx, (const uint8_t *)"ha ", 3);
#endif
}

static void close_(void *ctx) {
    (void)ctx;
#ifdef FAULT_CLOSE_LOOPS
    for (;;)
        sum++;
#endif
#ifdef FAULT_CLOSE_CRASHES
    *(volatile int *)8 = 1;
#endif
}

static int32_t vocabulary(void *ctx, void *host, PostEmitWord emit) {
    (void)ctx;
    emit(host, POST_MEANING_RAPID, (const uint8_t *)"G0", 2);
#ifdef FAULT_MEANING
    emit(host, 99999, (const uint8_t *)"G1", 2);
#endif
#ifdef FAULT_NO_WORD
    emit(host, POST_MEANING_RAPID, NULL, 2);
#endif
#ifdef FAULT_LONG_WORD
    emit(host, POST_MEANING_RAPID, (const uint8_t *)"G1", SIZE_MAX / 2);
#endif
#ifdef FAULT_MANY_WORDS
    for (int i = 0; i < 100000000; i++)
        emit(host, POST_MEANING_RAPID, (const uint8_t *)"G1", 2);
#endif
#ifdef FAULT_NO_VOCABULARY
    return 1;
#endif
    return 0;
}

static int32_t relies_on(void *ctx, const PostSink *out) {
    (void)ctx, (void)out;
#ifdef FAULT_NO_TEXT
    out->write(out->ctx, (const uint8_t *)"\377\376", 2);
#elif defined FAULT_RELIES
    return 1;
#elif defined FAULT_MANY_SENTENCES
    for (int i = 0; i < 1000; i++)
        out->write(out->ctx, (const uint8_t *)"one\n", 4);
#else
    const char *text = "option 1\n\n\033[2Joption 2\n";
    out->write(out->ctx, (const uint8_t *)text, strlen(text));
#endif
    return 0;
}

#if defined FAULT_MANY || defined FAULT_CHOICES || defined FAULT_NO_CHOICES || defined FAULT_KEY || defined FAULT_LONG \
    || defined FAULT_HELP || defined FAULT_TWICE || defined FAULT_UNALIGNED || defined FAULT_NOTHING
static void describe(void *host, PostEmit emit) {
    PostOption option = {0};
    option.key = (PostText)POST_TEXT("speed");
    option.kind = POST_OPTION_FLAG;
    option.default_value.kind = POST_OPTION_FLAG;
    int times = 1;
#ifdef FAULT_MANY
    times = 100000;
#endif
#ifdef FAULT_TWICE
    times = 2;
#endif
#ifdef FAULT_CHOICES
    option.kind = POST_OPTION_CHOICE;
    option.choices = &option.key;
    option.choices_len = SIZE_MAX / 8;
#endif
#ifdef FAULT_NO_CHOICES
    option.kind = POST_OPTION_CHOICE;
    option.choices = (const PostText *)((const char *)&option.key + 1);
    option.choices_len = 1;
#endif
#ifdef FAULT_KEY
    option.key = (PostText)POST_TEXT("a\nb");
#endif
#ifdef FAULT_LONG
    option.key.len = SIZE_MAX / 2 + 5;
#endif
#ifdef FAULT_HELP
    option.help.len = 7;
#endif
#ifdef FAULT_UNALIGNED
    emit(host, (const PostOption *)((const char *)&option + 1));
    return;
#endif
#ifdef FAULT_NOTHING
    emit(host, NULL);
    return;
#endif
    for (int i = 0; i < times; i++)
        emit(host, &option);
}
#elif defined FAULT_DEFAULT
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

static const PostDialect dialect = {open_, format, write_, last_error, close_, vocabulary, relies_on};

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
#elif defined(FAULT_EARLIER)
    offsetof(PostPlugin, about), /* a library of the first days of version 2 */
#else
    sizeof(PostPlugin),
#endif
#ifdef FAULT_TABLE_SIZE
    offsetof(PostDialect, vocabulary) - 8,
#elif defined(FAULT_EARLIER)
    offsetof(PostDialect, vocabulary),
#elif defined(FAULT_TABLE_HUGE)
    4000000000u,
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
#ifdef FAULT_VERSION
    POST_TEXT("1.0\033[2J"),
#elif defined(FAULT_LONG_VERSION)
    {(const uint8_t *)"1.0", SIZE_MAX / 2 + 5},
#else
    POST_TEXT("1.0"),
#endif
    describe,
    NULL,
#ifdef FAULT_NULL_TABLE
    NULL,
#elif defined(FAULT_ALIGN)
    (const PostDialect *)((const char *)&dialect + 1),
#else
    &dialect,
#endif
    NULL,
    POST_TEXT("It means no good."),
};
#endif
