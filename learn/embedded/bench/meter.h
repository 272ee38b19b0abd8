/* Instructions and bytes of stack that a part of a program takes on an emulated Cortex-M; 0 on the host. */
#ifndef METER_H
#define METER_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static inline void meter_fail(const char *why)
{
    fprintf(stderr, "%s\n", why);
    exit(EXIT_FAILURE);
}

#if defined(__ARM_ARCH_PROFILE) && __ARM_ARCH_PROFILE == 'M'

#define ALWAYS_INLINE static inline __attribute__((always_inline))

/* A timer of the board's peripherals: 32 bits, 25 MHz, counts down. SysTick has 24 bits. */
typedef struct {
    volatile uint32_t load, value, control, clear, ended;
} meter_timer;

#define TIMER ((meter_timer *)0x40002000u)
#define RUNS_WITH_32_BITS 0xC2u

ALWAYS_INLINE void meter_start(void)
{
    TIMER->load = UINT32_MAX;
}

/* Under QEMU's "-icount shift=7" an instruction takes 128 ns and a tick 40 ns: rounding gives the instructions. */
ALWAYS_INLINE uint32_t meter_stop(void)
{
    const uint32_t ticks = UINT32_MAX - TIMER->value;
    if (TIMER->ended)
        meter_fail("more instructions than the timer counts, 1.3e9: count a smaller part");
    return (uint32_t)(((uint64_t)ticks * 5 + 8) / 16);
}

/* Instructions of the meter itself, to subtract. */
static inline uint32_t meter_begin(void)
{
    TIMER->control = RUNS_WITH_32_BITS;
    TIMER->load = UINT32_MAX;
    TIMER->clear = 1;
    meter_start();
    return meter_stop();
}

#define PAINT 0x5AA5C33Cu
extern uint32_t stack_limit[];

ALWAYS_INLINE uint32_t *stack_pointer(void)
{
    uint32_t *pointer;
    __asm volatile("mov %0, sp" : "=r"(pointer));
    return pointer;
}

/* Inline, as both shall have the stack pointer of the function that calls what is measured. */
ALWAYS_INLINE void stack_paint(void)
{
    for (volatile uint32_t *word = stack_limit; word < stack_pointer(); word++)
        *word = PAINT;
}

ALWAYS_INLINE uint32_t stack_used(void)
{
    const volatile uint32_t *word = stack_limit;
    if (*word != PAINT)
        meter_fail("more stack than the megabyte there is");
    while (*word == PAINT)
        word++;
    return (uint32_t)((uintptr_t)stack_pointer() - (uintptr_t)word);
}

#else

static inline void meter_start(void) {}
static inline uint32_t meter_stop(void) { return 0; }
static inline uint32_t meter_begin(void) { return 0; }
static inline void stack_paint(void) {}
static inline uint32_t stack_used(void) { return 0; }

#endif

#endif
