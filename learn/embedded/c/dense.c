#include <math.h>

#include "dense.h"
#include "parameters.h"

void swg_apply(const swg_dense *layer, const float *input, float *output)
{
    const swg_weight *weight = layer->weight;
    for (int32_t r = 0; r < layer->rows; r++) {
        float sum = 0;
        for (int32_t c = 0; c < layer->columns; c++)
            sum += (float)*weight++ * input[c];
        sum = layer->bias[r] + layer->scale[r] * sum;
        output[r] = layer->rectified && sum < 0 ? 0 : sum;
    }
}

void swg_softmax(const float *logit, float probability[SWG_CLASSES])
{
    float highest = logit[0], sum = 0;
    for (int i = 1; i < SWG_CLASSES; i++)
        highest = fmaxf(highest, logit[i]);
    for (int i = 0; i < SWG_CLASSES; i++)
        sum += probability[i] = expf(logit[i] - highest);
    for (int i = 0; i < SWG_CLASSES; i++)
        probability[i] /= sum;
}

void swg_compress(const float row[SWG_COLUMNS], float compressed[SWG_COLUMNS])
{
    for (int i = 0; i < SWG_COLUMNS; i++)
#if SWG_COMPRESSED
        compressed[i] = asinhf((row[i] - swg_centre[i]) / swg_spread[i]);
#else
        compressed[i] = row[i];
#endif
}
