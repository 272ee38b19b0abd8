#include <math.h>

#include "residual.h"

#define VALUES (2 * SWG_GAUGES * SWG_ORDERS) /* real and imaginary parts of the orders from 1 on */

/* Least squares by Gram-Schmidt with what is likely as further rows: single precision would not do for the squares. */
static void fit(float column[SWG_ERRORS + 1][VALUES + SWG_ERRORS], float solution[SWG_ERRORS])
{
    float r[SWG_ERRORS][SWG_ERRORS + 1];
    for (int i = 0; i < SWG_ERRORS; i++) {
        float square = 0;
        for (int v = 0; v < VALUES + SWG_ERRORS; v++)
            square += column[i][v] * column[i][v];
        for (int j = i + 1; j <= SWG_ERRORS; j++) {
            float product = 0;
            for (int v = 0; v < VALUES + SWG_ERRORS; v++)
                product += column[i][v] * column[j][v];
            r[i][j] = product / square;
            for (int v = 0; v < VALUES + SWG_ERRORS; v++)
                column[j][v] -= r[i][j] * column[i][v];
        }
    }
    for (int i = SWG_ERRORS - 1; i >= 0; i--) {
        solution[i] = r[i][SWG_ERRORS];
        for (int j = i + 1; j < SWG_ERRORS; j++)
            solution[i] -= r[i][j] * solution[j];
    }
}

void swg_residual(const swg_window *window, swg_lines lines, float error[SWG_ERRORS])
{
    const swg_point *point = window->point;
    const swg_lines *change = (const swg_lines *)point->healthy; /* of the healthy lines, per unit of each error */
    const float likely[SWG_ERRORS] = {SWG_LIKELY_LOAD * fabsf(point->T_out), SWG_LIKELY_ANGLE, SWG_LIKELY_SPEED};
    float column[SWG_ERRORS + 1][VALUES + SWG_ERRORS] = {0};
    swg_lines_of(window, lines);
    int v = 0;
    for (int i = 0; i < SWG_GAUGES; i++)
        for (int k = 1; k <= SWG_ORDERS; k++, v += 2) {
            for (int e = 0; e < SWG_ERRORS; e++) {
                column[e][v] = change[e][i][k].re * likely[e] / SWG_LIKELY_LINE;
                column[e][v + 1] = change[e][i][k].im * likely[e] / SWG_LIKELY_LINE;
            }
            column[SWG_ERRORS][v] = lines[i][k].re / SWG_LIKELY_LINE;
            column[SWG_ERRORS][v + 1] = lines[i][k].im / SWG_LIKELY_LINE;
        }
    for (int e = 0; e < SWG_ERRORS; e++)
        column[e][VALUES + e] = 1;
    fit(column, error);
    for (int e = 0; e < SWG_ERRORS; e++) {
        error[e] *= likely[e];
        for (int i = 0; i < SWG_GAUGES; i++)
            for (int k = 0; k <= SWG_ORDERS; k++) {
                lines[i][k].re -= error[e] * change[e][i][k].re;
                lines[i][k].im -= error[e] * change[e][i][k].im;
            }
    }
}

float *swg_side(const swg_window *window, const swg_operation *operation, float *row)
{
    const swg_point *point = window->point;
    if (SWG_EFFICIENCY) {
        const float change = log1pf((operation->efficiency - point->efficiency) / point->efficiency);
        const float loss = 1 / operation->efficiency - 1 / point->efficiency;
        *row++ = change;
        *row++ = copysignf(sqrtf(sqrtf(fabsf(change))), change);
        *row++ = loss * point->T_out / (point->n_in * 0.104719755f); /* at the speed in rad/s */
    }
    if (SWG_OPERATING_POINT) {
        const float warmer = operation->temperature - point->temperature;
        *row++ = point->n_in;
        *row++ = point->T_out;
        *row++ = isnan(warmer) ? 0 : warmer;
    }
    return row;
}
