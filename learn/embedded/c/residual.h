/* Order lines relative to the healthy gear, without what errors of load, trigger and speed change in them. */
#ifndef SWG_RESIDUAL_H
#define SWG_RESIDUAL_H

#include "lines.h"

#define SWG_ERRORS 3

/* What remains of the lines, and the most probable errors that were taken out: of the load [N m], of the trigger's angle
 * [rad] and of the speed [-]. */
void swg_residual(const swg_window *window, swg_lines lines, float error[SWG_ERRORS]);

/* Columns beside the signal, efficiency and operating point; where the next column begins. */
float *swg_side(const swg_window *window, const swg_operation *operation, float *row);

#endif
