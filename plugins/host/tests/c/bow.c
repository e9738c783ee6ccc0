/* The smallest error model in C: the deviation along a move is a parabola through its middle.
 *
 *     cc -O2 -shared -fPIC -I plugins/api/include bow.c -o libpost_bow.so
 */
#include "post_plugin.h"

#include <stdlib.h>

/* Pieces in which the peak is looked for: a vector of parabolas has up to three. */
enum { PIECES = 64 };

typedef struct {
    double half; /* where the middle is asked for, t */
} Context;

static void describe(void *host, PostEmit emit) {
    PostOption half = post_number_option("half", "Where the bow is looked at, as a share of the move.", 0.25, 0.75, 0.5);
    emit(host, &half);
}

static void *open_(const PostPair *options, size_t n, const PostSink *error) {
    const PostValue *half = post_option(options, n, "half");
    Context *c = half ? calloc(1, sizeof *c) : NULL;
    if (c == NULL) {
        post_put(error, half ? "out of memory" : "the host does not say `half`");
        return NULL;
    }
    c->half = half->number;
    return c;
}

/* Component `i` of the curve at t: 0 to 2 the tip, mm, 3 to 5 the tool axis, degrees. The terms are where the move starts,
 * where it ends (off the path by the rounding of the words) and the bow above the chord between these. */
static double component(const PostCurve *curve, size_t i, double t) {
    double start = curve->terms[i], end = curve->terms[6 + i], bow = curve->terms[12 + i];
    return start + (end - start) * t + bow * 4 * t * (1 - t);
}

static void values(const PostCurve *curve, double t, PostDeviation *out) {
    for (size_t i = 0; i < 3; i++) {
        out->tip[i] = component(curve, i, t);
        out->axis[i] = component(curve, 3 + i, t);
    }
}

static void peak(const double part[3], double t, double *most, double *at) {
    double length = sqrt(part[0] * part[0] + part[1] * part[1] + part[2] * part[2]);
    if (length > *most) {
        *most = length;
        *at = t;
    }
}

/* Asks at the ends and at one place between them: each costs the host a solution of the chain. */
static int32_t fit(void *ctx, const PostTolerance *tolerance, PostDeviationFn deviation, void *host, PostCurve *curve) {
    (void)tolerance;
    const Context *c = ctx;
    const double ts[3] = {0, c->half, 1};
    PostDeviation found[3];
    deviation(host, 3, ts, found);
    PostCurve fitted = {0};
    for (size_t i = 0; i < 6; i++) {
        double at[3];
        for (size_t k = 0; k < 3; k++)
            at[k] = i < 3 ? found[k].tip[i] : found[k].axis[i - 3];
        double chord = at[0] + (at[2] - at[0]) * c->half;
        fitted.terms[i] = at[0];
        fitted.terms[6 + i] = at[2];
        fitted.terms[12 + i] = (at[1] - chord) / (4 * c->half * (1 - c->half));
        if (!isfinite(fitted.terms[12 + i]))
            return 1;
    }
    fitted.tip_at = fitted.axis_at = 0.5;
    for (int step = 0; step <= PIECES; step++) {
        double t = (double)step / PIECES;
        PostDeviation there;
        values(&fitted, t, &there);
        peak(there.tip, t, &fitted.tip_peak, &fitted.tip_at);
        peak(there.axis, t, &fitted.axis_peak, &fitted.axis_at);
    }
    *curve = fitted;
    return 0;
}

/* Reads nothing but the terms: the curve may be that of a move before. */
static int32_t value(void *ctx, const PostCurve *curve, size_t n, const double *ts, PostDeviation *out) {
    (void)ctx;
    for (size_t i = 0; i < n; i++)
        values(curve, ts[i], &out[i]);
    return 0;
}

/* `fit` fails for one reason alone. */
static void last_error(void *ctx, const PostSink *out) {
    (void)ctx;
    post_put(out, "a deviation is no number");
}

static void close_(void *ctx) {
    free(ctx);
}

static const PostModel model = {open_, fit, value, last_error, close_};

POST_EXPORT const PostPlugin post_plugin_bow;
const PostPlugin post_plugin_bow = {
    POST_HEAD(POST_KIND_MODEL, PostModel),
    POST_TEXT("bow"),
    POST_TEXT("1.0"),
    describe,
    NULL,
    NULL,
    &model,
    POST_TEXT("A parabola through the middle of the move."),
};
