/* From reset to main on a Cortex-M with a floating point unit, with newlib's files and exit by semihosting. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define CPACR (*(volatile uint32_t *)0xE000ED88u) /* coprocessor access control; 10 and 11 are the FPU */
#define SYS_EXIT 0x18u
#define RUN_TIME_ERROR 0x20023u

extern uint32_t stack_top[], data_load[], data_start[], data_end[], bss_start[], bss_end[];
void initialise_monitor_handles(void); /* of newlib's librdimon */
int main(void);

void reset(void)
{
    CPACR |= 0xFu << 20;
    __asm volatile("dsb\n isb" ::: "memory");
    memcpy(data_start, data_load, (size_t)((char *)data_end - (char *)data_start));
    memset(bss_start, 0, (size_t)((char *)bss_end - (char *)bss_start));
    initialise_monitor_handles();
    exit(main());
}

/* The emulator ends with a status of 1. */
static void fault(void)
{
    register uint32_t call __asm("r0") = SYS_EXIT;
    register uint32_t reason __asm("r1") = RUN_TIME_ERROR;
    __asm volatile("bkpt 0xAB" ::"r"(call), "r"(reason) : "memory");
    for (;;)
        continue;
}

/* Reset, NMI and the faults; interrupts are not used. */
__attribute__((section(".vectors"), used)) static void (*const vectors[])(void) = {
    (void (*)(void))stack_top, reset, fault, fault, fault, fault, fault,
};
