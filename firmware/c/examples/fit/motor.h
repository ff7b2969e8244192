/* A simulated motor in the place of a board. */
#ifndef MOTOR_H
#define MOTOR_H

#include <stdint.h>

/* Puts the shaft to rest where it is. */
void motor_reset(void);

/* Drives for a control period with a duty (32,768 is the supply); gives the counts that the encoder went on by. */
int32_t motor_period(int16_t duty);

#endif
