/* Convolutions over the revolution with strides of two, pooled over the angle and joined by the side columns. */
#include <math.h>
#include <string.h>

#include "parameters.h"

/* Circular over the angle; input and output channel after channel. */
static void convolve(const swg_convolution *block, int points, const float *input, float *output)
{
    float patch[SWG_PATCH], column[SWG_WIDEST];
    const int half = points / 2;
    for (int at = 0; at < half; at++) {
        float *next = patch;
        for (int32_t c = 0; c < block->channels; c++)
            for (int32_t k = 0; k < block->kernel; k++)
                *next++ = input[c * points + (2 * at + k - block->kernel / 2 + points) % points];
        swg_apply(&block->filter, patch, column);
        for (int32_t f = 0; f < block->filter.rows; f++)
            output[f * half + at] = column[f];
    }
}

/* Mean and greatest value of each channel. */
static void pool(const float *signal, int32_t channels, int points, float *mean, float *greatest)
{
    for (int32_t c = 0; c < channels; c++, signal += points) {
        float sum = signal[0];
        greatest[c] = signal[0];
        for (int i = 1; i < points; i++) {
            sum += signal[i];
            greatest[c] = fmaxf(greatest[c], signal[i]);
        }
        mean[c] = sum / (float)points;
    }
}

void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES])
{
    float one[SWG_LARGEST], other[SWG_LARGEST], joined[SWG_WIDEST], hidden[SWG_WIDEST];
    float *from = one, *to = other;
    int points = SWG_POINTS;
    swg_compress(row, from);
    swg_apply(&swg_beside, from + SWG_CHANNELS * SWG_POINTS, hidden);
    for (int i = 0; i < SWG_BLOCKS; i++, points /= 2) {
        convolve(&swg_block[i], points, from, to);
        float *const swapped = from;
        from = to;
        to = swapped;
    }
    const int32_t channels = swg_block[SWG_BLOCKS - 1].filter.rows;
    pool(from, channels, points, joined, joined + channels);
    memcpy(joined + 2 * channels, hidden, (size_t)swg_beside.rows * sizeof *hidden);
    swg_apply(&swg_layer[0], joined, hidden);
    swg_apply(&swg_layer[1], hidden, joined);
    swg_softmax(joined, probability);
}
