/* Fully connected layers. */
#include "parameters.h"

void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES])
{
    float one[SWG_WIDEST], other[SWG_WIDEST];
    float *from = one, *to = other;
    swg_compress(row, from);
    for (int i = 0; i < SWG_LAYERS; i++) {
        swg_apply(&swg_layer[i], from, to);
        float *const swapped = from;
        from = to;
        to = swapped;
    }
    swg_softmax(from, probability);
}
