/* What comes before main on the Cortex-M of an emulated MPS2 board, whose memory is at zero; the C library's own start does the rest. */
#include <stdint.h>

extern void _start(void);

/* The coprocessor access control register: who uses the floating-point unit before it is on faults. */
#define CPACR (*(volatile uint32_t *)0xE000ED88u)

static void reset(void) {
#ifdef __ARM_FP
  CPACR |= 0xFu << 20;
  __asm volatile("dsb\n isb");
#endif
  _start();
}

static void fault(void) {
  for (;;) {
  }
}

typedef void (*Vector)(void);

/* The stack until the C library has set its own, and the exceptions of every core. */
extern const Vector vectors[16];
__attribute__((section(".vectors"))) const Vector vectors[16] = {
    (Vector)0x20010000, reset, fault, fault, fault, fault, fault, fault,
    fault, fault, fault, fault, fault, fault, fault, fault,
};
