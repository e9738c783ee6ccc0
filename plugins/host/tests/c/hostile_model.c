/* An error model with one fault, chosen by -DFAULT_…. */
#include "post_plugin.h"

#include <fenv.h>

static int context;

static void *open_(const PostPair *options, size_t n, const PostSink *error) {
    (void)options, (void)n, (void)error;
    return &context;
}

static int32_t fit(void *ctx, const PostTolerance *tolerance, PostDeviationFn deviation, void *host, PostCurve *curve) {
    (void)ctx, (void)tolerance;
    double t[2] = {0.5, 0.5};
    PostDeviation found[2];
#ifdef FAULT_ROUND
    fesetround(FE_UPWARD);
#endif
#ifdef FAULT_COUNT
    deviation(host, (size_t)-1 / 8, t, found);
#elif defined FAULT_NULL
    deviation(host, 1, NULL, found);
#elif defined FAULT_ALIGN
    deviation(host, 1, (const double *)((const char *)t + 1), found);
#endif
#ifdef FAULT_ASKS_ON
    for (;;)
        deviation(host, 2, t, found);
#endif
    deviation(host, 1, t, found);
    PostCurve flat = {0};
    flat.tip_peak = found[0].tip[0];
    *curve = flat;
    return 0;
}

static int32_t value(void *ctx, const PostCurve *curve, size_t n, const double *ts, PostDeviation *out) {
    (void)ctx, (void)curve, (void)ts;
    PostDeviation none = {0};
    for (size_t i = 0; i < n; i++)
        out[i] = none;
#ifdef FAULT_ROUND
    fesetround(FE_UPWARD);
#endif
    return 0;
}

static void last_error(void *ctx, const PostSink *out) {
    (void)ctx, (void)out;
}

static void close_(void *ctx) {
    (void)ctx;
}

static const PostModel model = {open_, fit, value, last_error, close_};

POST_EXPORT const PostPlugin post_plugin_hostile_model;
const PostPlugin post_plugin_hostile_model = {
    POST_HEAD(POST_KIND_MODEL, PostModel), POST_TEXT("hostile_model"), POST_TEXT("1.0"), NULL, NULL, NULL, &model,
    POST_TEXT(""),
};
