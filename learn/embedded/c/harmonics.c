/* Features that follow from the symmetries of the gear: what a fault changes, wherever it sits. */
#include <math.h>

#include "residual.h"

/* Component of s1 to s4, as a Fourier series around the circumference, at a wave number from 0 to 3. */
static swg_complex around(const swg_complex s1, const swg_complex s2, const swg_complex s3, const swg_complex s4, int wave)
{
    const swg_complex even = wave % 2 ? (swg_complex){s1.re - s3.re, s1.im - s3.im}
                                      : (swg_complex){s1.re + s3.re, s1.im + s3.im};
    const swg_complex odd = wave % 2 ? (swg_complex){s2.re - s4.re, s2.im - s4.im}
                                     : (swg_complex){s2.re + s4.re, s2.im + s4.im};
    switch (wave) {
    case 0: return (swg_complex){(even.re + odd.re) / 4, (even.im + odd.im) / 4};
    case 1: return (swg_complex){(even.re + odd.im) / 4, (even.im - odd.re) / 4};
    case 2: return (swg_complex){(even.re - odd.re) / 4, (even.im - odd.im) / 4};
    default: return (swg_complex){(even.re - odd.im) / 4, (even.im + odd.re) / 4};
    }
}

static swg_complex over(swg_complex a, swg_complex b)
{
    const float square = b.re * b.re + b.im * b.im;
    return (swg_complex){(a.re * b.re + a.im * b.im) / square, (a.im * b.re - a.re * b.im) / square};
}

/* Of the torque gauge, kept from vanishing as it is divided by. */
static swg_complex healthy_ripple(const swg_point *point, int order)
{
    const float quarters = 4 * swg_this_gear.scale;
    const swg_complex line = {(float)point->line[order].re / quarters, (float)point->line[order].im / quarters};
    const float size = swg_magnitude(line);
    if (size == 0)
        return (swg_complex){SWG_SMALLEST_RIPPLE, 0};
    const float factor = fmaxf(size, SWG_SMALLEST_RIPPLE) / size;
    return (swg_complex){line.re * factor, line.im * factor};
}

void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS])
{
    static const int ripple[] = SWG_RIPPLE_ORDERS;
    swg_lines lines;
    float error[SWG_ERRORS];
    swg_residual(window, lines, error);
    for (int i = 0; i < SWG_GAUGES; i++)
        *row++ = lines[i][0].re;
    for (int k = 0; k <= SWG_ORDERS; k += 2)
        for (int wave = 0; wave < 4; wave++)
            *row++ = swg_magnitude(around(lines[1][k], lines[2][k], lines[3][k], lines[4][k], wave));
    for (unsigned i = 0; i < sizeof ripple / sizeof *ripple; i++) {
        const int k = ripple[i];
        const swg_complex healthy = healthy_ripple(window->point, k);
        const swg_complex torque = lines[0][k], mean = around(lines[1][k], lines[2][k], lines[3][k], lines[4][k], 0);
        const swg_complex part[] = {torque, over(torque, healthy), over(mean, healthy)};
        for (int p = 0; p < 3; p++) {
            *row++ = part[p].re;
            *row++ = part[p].im;
        }
    }
    row = swg_side(window, operation, row);
    for (int e = 0; e < SWG_ERRORS; e++)
        *row++ = error[e];
}
