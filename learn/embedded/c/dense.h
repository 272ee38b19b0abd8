/* A fully connected layer, or its rows of small integers with a scale each. */
#ifndef SWG_DENSE_H
#define SWG_DENSE_H

#include "swg.h"

typedef SWG_WEIGHT swg_weight;

typedef struct {
    int32_t rows, columns;
    bool rectified;            /* negative outputs are set to 0 */
    const swg_weight *weight;  /* [rows][columns] */
    const float *scale, *bias; /* [rows]; output = bias + scale * (weight times input) */
} swg_dense;

void swg_apply(const swg_dense *layer, const float *input, float *output);

/* Classes from logits. */
void swg_softmax(const float *logit, float probability[SWG_CLASSES]);

/* The row as the network sees it: linear up to about one standard deviation and logarithmic beyond. */
void swg_compress(const float row[SWG_COLUMNS], float compressed[SWG_COLUMNS]);

#endif
