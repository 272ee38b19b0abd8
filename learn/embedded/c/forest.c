/* Decision trees that vote with the class probabilities of their leaves.
 *
 * The splits of all trees lie in the order in which a walk that turns left first meets them, and so do the leaves. As a
 * subtree of n leaves has n - 1 splits, the number of leaves on the left of a split leads to its right in both orders;
 * nothing else is kept of the shape of a tree.
 */
#include "forest_tables.h"
#include "swg.h"

#if SWG_CODED
/* Linear near the centre and logarithmic beyond, as asinh is: the bits of a float from 1 on grow with its logarithm. */
static int16_t coded(float value, int i)
{
    const float distance = (value - centre[i]) * steepness[i];
    const union {
        float number;
        int32_t bits;
    } one = {1}, size = {1 + (distance < 0 ? -distance : distance)};
    const float steps = (float)(size.bits - one.bits) * gain[i];
    const int16_t code = steps < INT16_MAX ? (int16_t)steps : INT16_MAX;
    return distance < 0 ? (int16_t)-code : code;
}
#endif

/* The leaf that a row falls into, of a tree that begins at these. */
static uint32_t reached(const SWG_VALUE *value, uint32_t split, uint32_t leaf, uint32_t count)
{
    while (count > 1) {
        const uint32_t on_left = left_leaves[split];
        if (value[column[split]] <= threshold[split]) {
            split += 1;
            count = on_left;
        } else {
            split += on_left;
            leaf += on_left;
            count -= on_left;
        }
    }
    return leaf;
}

void swg_classify(const float row[SWG_COLUMNS], float probability[SWG_CLASSES])
{
#if SWG_CODED
    int16_t value[SWG_COLUMNS];
    for (int i = 0; i < SWG_COLUMNS; i++)
        value[i] = coded(row[i], i);
#else
    const float *const value = row;
#endif
    uint32_t votes[SWG_CLASSES] = {0}, all = 0, split = 0, leaf = 0;
    for (int tree = 0; tree < SWG_TREES; tree++) {
        const uint32_t count = leaves[tree];
        const uint32_t found = ballot[reached(value, split, leaf, count)];
        split += count - 1;
        leaf += count;
        for (int i = 0; i < SWG_CLASSES; i++)
            votes[i] += vote[SWG_CLASSES * found + (uint32_t)i];
    }
    for (int i = 0; i < SWG_CLASSES; i++)
        all += votes[i];
    for (int i = 0; i < SWG_CLASSES; i++)
        probability[i] = (float)votes[i] / (float)all;
}
