/* Order lines of a whole window. */
#ifndef SWG_LINES_H
#define SWG_LINES_H

#include <math.h>
#include <stddef.h>

#include "swg.h"

typedef swg_complex swg_lines[SWG_GAUGES][SWG_ORDERS + 1];

/* Complex amplitudes [mV/V] of the gauges at the orders 0, the mean, to SWG_ORDERS; less the healthy ones of the point
 * if it has any. */
void swg_lines_of(const swg_window *window, swg_lines lines);

/* Mean of a gauge less its healthy mean [mV/V]. */
float swg_deviation(const swg_window *window, int gauge);

static inline float swg_magnitude(swg_complex z)
{
    return sqrtf(z.re * z.re + z.im * z.im);
}

#endif
