/* One revolution of the gauges relative to the healthy gear, as a signal over the angle of the wave generator. */
#include "residual.h"

void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS])
{
    static const float cosine[SWG_POINTS] = SWG_COSINES; /* cos(2 pi n / SWG_POINTS) */
    swg_lines lines;
    float error[SWG_ERRORS];
    swg_residual(window, lines, error);
    for (int i = 0; i < SWG_GAUGES; i++)
        for (int n = 0; n < SWG_POINTS; n++) {
            float value = lines[i][0].re;
            for (int k = 1; k <= SWG_ORDERS; k++) { /* the sine is the cosine a quarter later */
                const int at = k * n % SWG_POINTS;
                value += lines[i][k].re * cosine[at] - lines[i][k].im * cosine[(at + 3 * SWG_POINTS / 4) % SWG_POINTS];
            }
            *row++ = value;
        }
    row = swg_side(window, operation, row);
    for (int e = 0; e < SWG_ERRORS; e++)
        *row++ = error[e];
}
