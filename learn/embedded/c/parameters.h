/* The trained numbers, in parameters.c. */
#ifndef SWG_PARAMETERS_H
#define SWG_PARAMETERS_H

#include "dense.h"

extern const float swg_centre[SWG_COLUMNS], swg_spread[SWG_COLUMNS];
extern const swg_dense swg_layer[SWG_LAYERS];

#ifdef SWG_CHANNELS /* a convolutional network */
typedef struct {
    int32_t channels, kernel; /* of the input */
    swg_dense filter;         /* of channels * kernel columns */
} swg_convolution;

extern const swg_convolution swg_block[SWG_BLOCKS];
extern const swg_dense swg_beside; /* of the columns behind the signal */
#endif

#endif
