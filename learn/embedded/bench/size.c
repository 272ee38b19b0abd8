/* The smallest firmware: what it links is what an exported method needs. */
#include "swg.h"

static swg_window window;

int firmware(const swg_operation *operation, const float (*sample)[SWG_GAUGES], float probability[SWG_CLASSES])
{
    while (!swg_push(&window, operation, *sample++))
        continue;
    return swg_decide(&window, operation, probability);
}
