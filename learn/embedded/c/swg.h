/* The condition of a strain wave gear, from one window of its strain gauges.
 *
 * Call swg_push with every sample from an index pulse of the wave generator on; when it returns true the window is
 * whole, and swg_decide gives the class. Nothing is allocated, and nothing is kept but in the window. The next swg_push
 * begins a new window: it must not come before swg_decide has returned, as from an interrupt, or it needs another one.
 */
#ifndef SWG_H
#define SWG_H

#include <stdbool.h>
#include <stdint.h>

#include "model.h" /* SWG_ORDERS, SWG_COLUMNS, SWG_CLASSES, and SWG_CLASS_NAMES to initialise an array of strings with */

#ifdef __cplusplus
extern "C" {
#endif

#define SWG_GAUGES 5 /* s0 senses torque, s1 to s4 sit around the flex spline */

/* What the drive knows beside the gauges. */
typedef struct {
    float n_in;        /* set speed of the wave generator [rpm] */
    float T_out;       /* set load torque at the output [N m] */
    float efficiency;  /* output power over input power, at most 1; of the window when swg_decide is called */
    float temperature; /* of the gear [degC]; NAN of math.h where it is not measured */
} swg_operation;

#define SWG_LINES (SWG_ORDERS > 0 ? SWG_ORDERS : 1)

typedef struct {
    float re, im;
} swg_complex;

typedef struct {
    int32_t re, im;
} swg_fixed;

/* The healthy gear at one operating point, which its commissioning writes. */
typedef struct {
    float n_in, T_out, efficiency, temperature; /* as above; means of the healthy recordings */
    int32_t samples;                            /* that hold whole revolutions of the wave generator */
    float mean[SWG_GAUGES];                     /* of each gauge [mV/V] */
    float range[SWG_GAUGES];                    /* least movement of each gauge in a quarter of the samples [mV/V] */
    swg_fixed turn[SWG_LINES];                  /* exp(-i k angle) of the angle between two samples, k from 1 on; 2^30 */
    swg_complex offset[SWG_LINES];              /* mean over the samples of exp(-i k angle), about 0 */
    const swg_fixed *line;                      /* order lines in quarters of counts, or NULL: [SWG_GAUGES][SWG_ORDERS + 1] */
    const float *healthy;                       /* what else the features are set in relation to */
} swg_point;

/* The gear: gear.c, the one file that differs from gear to gear. */
typedef struct {
    float rate;       /* of the samples [Hz] */
    float saturation; /* of the amplifiers [mV/V] */
    float scale;      /* counts to 1 mV/V, such that no sum of a window overflows */
    int32_t points;
    const swg_point *point;
} swg_gear;

extern const swg_gear swg_this_gear;

/* A window while it is taken. Set it to zero once, before the first sample. */
typedef struct {
    const swg_point *point;           /* NULL: the operating point was not commissioned */
    swg_operation begun;              /* the operation at the first sample */
    int32_t count;                    /* of samples taken */
    uint32_t faults;                  /* bits of swg_fault */
    swg_fixed wave[SWG_LINES];        /* exp(-i k angle); 2^30 */
    int32_t low[SWG_GAUGES];          /* of the deviations from the healthy mean, in counts: extremes of a quarter, */
    int32_t high[SWG_GAUGES];
    int64_t sum[SWG_GAUGES];          /* sums of them, of their squares (of 8 counts) */
    int64_t squares[SWG_GAUGES];
    struct {
        int64_t re, im;
    } line[SWG_GAUGES][SWG_LINES];    /* and of them times the waves, 2^24 */
} swg_window;

/* Why there is no decision. */
typedef enum {
    SWG_NOT_COMMISSIONED = 1, /* no healthy recordings at this speed and load */
    SWG_NOT_WHOLE = 2,        /* asked before the window was whole */
    SWG_NOT_STEADY = 4,       /* the set speed or load was changed within the window */
    SWG_NOT_A_NUMBER = 8,     /* in a sample, or a quantity that cannot be: an efficiency that is not in (0, 1] */
    SWG_SATURATED = 16,       /* a gauge at the end of the range of its amplifier */
    SWG_DEAD_GAUGE = 32       /* a gauge that hardly moved for a quarter of the window */
} swg_fault;

/* Take one sample of the gauges [mV/V]; true when the window is whole, or will never be as its operating point was not
 * commissioned. The sample after that begins the next one. */
bool swg_push(swg_window *window, const swg_operation *operation, const float sample[SWG_GAUGES]);

/* The class, as its number in SWG_CLASS_NAMES, with the probability of each; or no decision, the reasons being the
 * bits of swg_fault in the negative of the result, and all probabilities 0. */
int swg_decide(const swg_window *window, const swg_operation *operation, float probability[SWG_CLASSES]);

/* The two parts of an exported method, which swg_decide calls one after the other. */
void swg_features(const swg_window *window, const swg_operation *operation, float row[SWG_COLUMNS]);
void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES]);

#ifdef __cplusplus
}
#endif

#endif
