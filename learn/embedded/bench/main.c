/* Decides on recordings.bin and writes decisions.bin, both in the working folder; running.py knows their layouts. */
#include <stdbool.h>

#include "meter.h"
#include "swg.h"

#define MAGIC 0x53574752u

typedef struct {
    uint32_t magic, recordings, samples, counted;
} file_header;

typedef struct {
    int32_t result;
    uint32_t stack;
    uint32_t window, push, decide, features, classify; /* instructions; push is the longest of the window */
    float probability[SWG_CLASSES];
} file_decision;

static swg_window window;
static uint32_t own; /* instructions of the meter */

static void count_parts(const swg_operation *operation, file_decision *decision)
{
    float row[SWG_COLUMNS], probability[SWG_CLASSES];
    meter_start();
    swg_features(&window, operation, row);
    decision->features = meter_stop() - own;
    meter_start();
    swg_classify(row, probability);
    decision->classify = meter_stop() - own;
}

static void decide(const file_header *header, const swg_operation *operation, float (*sample)[SWG_GAUGES],
                   file_decision *decision)
{
    static bool whole = false;
    if (!whole)
        window = (swg_window){0};
    if (header->counted)
        stack_paint();
    whole = false;
    for (uint32_t i = 0; i < header->samples && !whole; i++) {
        meter_start();
        whole = swg_push(&window, operation, sample[i]);
        const uint32_t push = meter_stop() - own;
        decision->window += push;
        if (push > decision->push)
            decision->push = push;
    }
    meter_start();
    decision->result = swg_decide(&window, operation, decision->probability);
    decision->decide = meter_stop() - own;
    if (header->counted) {
        decision->stack = stack_used();
        if (decision->result >= 0)
            count_parts(operation, decision);
    }
}

static void take(void *into, size_t bytes, FILE *recordings)
{
    if (fread(into, 1, bytes, recordings) != bytes)
        meter_fail("recordings.bin is cut short");
}

static void give(const void *from, size_t bytes, FILE *decisions)
{
    if (fwrite(from, 1, bytes, decisions) != bytes)
        meter_fail("decisions.bin cannot be written");
}

int main(void)
{
    FILE *recordings = fopen("recordings.bin", "rb"), *decisions = fopen("decisions.bin", "wb");
    if (recordings == NULL || decisions == NULL)
        meter_fail("recordings.bin or decisions.bin cannot be opened");
    file_header header;
    take(&header, sizeof header, recordings);
    if (header.magic != MAGIC)
        meter_fail("recordings.bin is none");
    const size_t bytes = header.samples * sizeof(float[SWG_GAUGES]);
    float(*sample)[SWG_GAUGES] = malloc(bytes);
    if (sample == NULL)
        meter_fail("no memory for a recording");
    const uint32_t classes = SWG_CLASSES;
    give(&classes, sizeof classes, decisions);
    own = meter_begin();
    for (uint32_t i = 0; i < header.recordings; i++) {
        swg_operation operation;
        file_decision decision = {0};
        take(&operation, sizeof operation, recordings);
        take(sample, bytes, recordings);
        decide(&header, &operation, sample, &decision);
        give(&decision, sizeof decision, decisions);
    }
    free(sample);
    fclose(recordings);
    return fclose(decisions);
}
