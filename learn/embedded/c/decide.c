/* From a whole window to a class, or to the reasons why there is none. */
#include <math.h>
#include <string.h>

#include "swg.h"

#define COLDEST -60.0f /* of a gear that is measured [degC] */
#define HOTTEST 250.0f

static uint32_t faults(const swg_window *window, const swg_operation *operation)
{
    uint32_t found = window->faults;
    if (window->count == 0)
        return found | SWG_NOT_WHOLE;
    if (window->point == NULL)
        return found | SWG_NOT_COMMISSIONED;
    if (window->count < window->point->samples)
        found |= SWG_NOT_WHOLE;
    if (!(operation->efficiency > 0 && operation->efficiency <= 1))
        found |= SWG_NOT_A_NUMBER;
    if (operation->temperature < COLDEST || operation->temperature > HOTTEST)
        found |= SWG_NOT_A_NUMBER;
    return found;
}

static bool all_finite(const float *value, int count)
{
    for (int i = 0; i < count; i++)
        if (!isfinite(value[i]))
            return false;
    return true;
}

int swg_decide(const swg_window *window, const swg_operation *operation, float probability[SWG_CLASSES])
{
    float row[SWG_COLUMNS];
    uint32_t found = faults(window, operation);
    if (found == 0) {
        swg_features(window, operation, row);
        if (all_finite(row, SWG_COLUMNS)) {
            swg_classify(row, probability);
            if (!all_finite(probability, SWG_CLASSES))
                found = SWG_NOT_A_NUMBER;
        } else {
            found = SWG_NOT_A_NUMBER;
        }
    }
    if (found) {
        memset(probability, 0, SWG_CLASSES * sizeof *probability);
        return -(int)found;
    }
    int best = 0;
    for (int i = 1; i < SWG_CLASSES; i++)
        if (probability[i] > probability[best])
            best = i;
    return best;
}
