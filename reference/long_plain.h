/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The solver `plain` in long double: the same recursions (solver/linear/plain.h), with 64 bits in
 * place of 53. A march by it loses only the rounding of loads and tip forces, which are doubles, so
 * the difference of another march from it is that march's round-off. Whether the equations are
 * right is checked by judges that share nothing with the solver.
 *
 * Against quadruple precision it is right to 1e-14 of a field's largest displacement, but to 1e-12
 * where friction holds the tip: the held tip creeps by the rounding of the force. */
#ifndef BR_REFERENCE_LONG_PLAIN_H
#define BR_REFERENCE_LONG_PLAIN_H

#include "solver/linear/linear_solver.h"

/* A row that is in no registry, without strain_rate. */
extern const struct br_linear_solver br_long_plain;

/* Whether long double has more digits than double, so that anything can be judged. */
bool br_long_plain_judges(void);

#endif
