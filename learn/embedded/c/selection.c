/* Features of Table III: mean, variance and DFT magnitudes in relation to the healthy gear (eqs. 7 to 9). */
#include <math.h>

#include "lines.h"

/* Eq. 7 as 1 + (m - healthy) / healthy, whose divisor alone is kept from falling below the floor. */
static float divisor(float healthy, float floor)
{
    return copysignf(fmaxf(fabsf(healthy), floor), healthy);
}

static float relative(float value, float healthy, float floor)
{
    return 1 + (value - healthy) / divisor(healthy, floor);
}

void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS])
{
    const swg_point *point = window->point;
    const float *healthy = point->healthy;
    const float length = (float)point->samples;
    swg_lines lines;
    swg_lines_of(window, lines);
    if (SWG_STATISTICS) {
        for (int i = 0; i < SWG_GAUGES; i++, healthy++)
            *row++ = 1 + swg_deviation(window, i) / divisor(*healthy, SWG_FLOOR);
        for (int i = 0; i < SWG_GAUGES; i++, healthy++) {
            const float mean = swg_deviation(window, i);
            const float unit = swg_this_gear.scale / 8;
            const float square = (float)window->squares[i] / (length * unit * unit);
            *row++ = relative(square - mean * mean, *healthy, SWG_FLOOR * SWG_FLOOR);
        }
    }
    if (SWG_GAUGE_SPECTRUM)
        for (int i = 0; i < SWG_GAUGES; i++)
            for (int k = 1; k <= SWG_ORDERS; k++, healthy++)
                *row++ = relative(swg_magnitude(lines[i][k]), *healthy, SWG_FLOOR);
    if (SWG_DIFFERENCE_SPECTRUM)
        for (int i = 1; i <= 2; i++)
            for (int k = 1; k <= SWG_ORDERS; k++, healthy++) { /* eq. 8: s1 - s3, s2 - s4 */
                const swg_complex a = lines[i][k], b = lines[i + 2][k];
                *row++ = relative(swg_magnitude((swg_complex){a.re - b.re, a.im - b.im}), *healthy, SWG_FLOOR);
            }
    const float lost = (point->efficiency - operation->efficiency) / point->efficiency; /* 1 - eta_rel */
    if (SWG_EFFICIENCY)
        *row++ = 1 - lost;
    if (SWG_ROOT_OF_EFFICIENCY)
        *row++ = sqrtf(sqrtf(fabsf(lost))); /* eq. 9 */
    if (SWG_OPERATING_POINT) {
        const float warmer = operation->temperature - point->temperature;
        *row++ = point->n_in;
        *row++ = point->T_out;
        *row++ = isnan(warmer) ? 0 : warmer;
    }
}
