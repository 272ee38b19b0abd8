#include "lines.h"

float swg_deviation(const swg_window *window, int gauge)
{
    return (float)window->sum[gauge] / ((float)window->point->samples * swg_this_gear.scale);
}

/* A line [mV/V] from its sum; the healthy one is taken off in integers, where nothing is lost. */
static float line_of(int64_t sum, int32_t samples, int32_t healthy)
{
    const int64_t line = 2 * (sum / samples) - (int64_t)healthy * (1 << 22);
    return (float)line / (16777216.0f * swg_this_gear.scale);
}

void swg_lines_of(const swg_window *window, swg_lines lines)
{
    const swg_point *point = window->point;
    for (int i = 0; i < SWG_GAUGES; i++) {
        const swg_fixed *healthy = point->line ? point->line + i * (SWG_ORDERS + 1) : NULL;
        const float deviation = swg_deviation(window, i);
        const float quarters = 4 * swg_this_gear.scale;
        const int32_t mean = (int32_t)lrintf(point->mean[i] * quarters);
        lines[i][0] = (swg_complex){deviation + (float)(mean - (healthy ? healthy[0].re : 0)) / quarters, 0};
        for (int k = 1; k <= SWG_ORDERS; k++) {
            const swg_complex offset = point->offset[k - 1];
            const swg_fixed known = healthy ? healthy[k] : (swg_fixed){0, 0};
            lines[i][k].re = line_of(window->line[i][k - 1].re, point->samples, known.re) - 2 * deviation * offset.re;
            lines[i][k].im = line_of(window->line[i][k - 1].im, point->samples, known.im) - 2 * deviation * offset.im;
        }
    }
}
