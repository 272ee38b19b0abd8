/* One pass over the samples: sums for mean, variance and order lines. Samples are not kept.
 *
 * In integers, whose sums are exact. A count is the gear's scale, a deviation has 30 bits and a wave 25, so that sums of
 * 512 samples fill 63 bits and a sign; the scale is coarser for longer windows. */
#include <limits.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "swg.h"

#define QUARTERS 4
#define ALIVE 0.1f /* share of its least healthy movement that a gauge makes in a quarter, at least */

static const swg_point *commissioned(const swg_operation *operation)
{
    for (int32_t i = 0; i < swg_this_gear.points; i++) {
        const swg_point *point = &swg_this_gear.point[i];
        if (point->n_in == operation->n_in && point->T_out == operation->T_out)
            return point->samples >= QUARTERS ? point : NULL;
    }
    return NULL;
}

static void begin_quarter(swg_window *window)
{
    for (int i = 0; i < SWG_GAUGES; i++) {
        window->low[i] = INT_MAX;
        window->high[i] = INT_MIN;
    }
}

static void end_quarter(swg_window *window)
{
    for (int i = 0; i < SWG_GAUGES; i++)
        if ((float)(window->high[i] - window->low[i]) < ALIVE * window->point->range[i] * swg_this_gear.scale)
            window->faults |= SWG_DEAD_GAUGE;
}

static void begin(swg_window *window, const swg_operation *operation)
{
    memset(window, 0, sizeof *window);
    window->begun = *operation;
    window->point = commissioned(operation);
    for (int k = 0; k < SWG_LINES; k++)
        window->wave[k].re = 1 << 30;
    begin_quarter(window);
}

/* a b - c d of numbers whose unit is 2^30. */
static int32_t rotated(int32_t a, int32_t b, int32_t c, int32_t d)
{
    return (int32_t)(((int64_t)a * b - (int64_t)c * d + (1 << 29)) >> 30);
}

static void add(swg_window *window, const float sample[SWG_GAUGES])
{
    int32_t deviation[SWG_GAUGES];
    for (int i = 0; i < SWG_GAUGES; i++) {
        const float counts = (sample[i] - window->point->mean[i]) * swg_this_gear.scale;
        const int32_t x = (int32_t)(counts < 0 ? counts - 0.5f : counts + 0.5f);
        deviation[i] = x;
        window->sum[i] += x;
        const int32_t coarse = (x + 4) >> 3;
        window->squares[i] += (int64_t)coarse * coarse;
        window->low[i] = x < window->low[i] ? x : window->low[i];
        window->high[i] = x > window->high[i] ? x : window->high[i];
    }
    for (int k = 0; k < SWG_ORDERS; k++) {
        const swg_fixed w = window->wave[k], turn = window->point->turn[k];
        for (int i = 0; i < SWG_GAUGES; i++) {
            window->line[i][k].re += (int64_t)deviation[i] * (w.re >> 6);
            window->line[i][k].im += (int64_t)deviation[i] * (w.im >> 6);
        }
        window->wave[k].re = rotated(w.re, turn.re, w.im, turn.im);
        window->wave[k].im = rotated(w.re, turn.im, -w.im, turn.re);
    }
}

bool swg_push(swg_window *window, const swg_operation *operation, const float sample[SWG_GAUGES])
{
    if (window->count == 0 || window->point == NULL || window->count >= window->point->samples)
        begin(window, operation);
    window->count++;
    if (window->point == NULL)
        return true; /* swg_decide says so */
    if (operation->n_in != window->begun.n_in || operation->T_out != window->begun.T_out)
        window->faults |= SWG_NOT_STEADY;
    for (int i = 0; i < SWG_GAUGES; i++) {
        if (!isfinite(sample[i]))
            window->faults |= SWG_NOT_A_NUMBER;
        if (fabsf(sample[i]) >= swg_this_gear.saturation)
            window->faults |= SWG_SATURATED;
    }
    const bool whole = window->count == window->point->samples;
    if (window->faults & (SWG_NOT_A_NUMBER | SWG_SATURATED)) /* which could overflow */
        return whole;
    add(window, sample);
    const int32_t quarter = window->point->samples / QUARTERS;
    if (whole || (window->count % quarter == 0 && window->count < QUARTERS * quarter)) {
        end_quarter(window);
        begin_quarter(window);
    }
    return whole;
}
