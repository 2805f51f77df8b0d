// SPDX-FileCopyrightText: The uel-harness authors
// SPDX-License-Identifier: BSD-3-Clause
// UEL in C, or in C++: a linear spring between two nodes, of stiffness PROPS(1).
#include <aba_for_c.h>

#ifdef __cplusplus
extern "C"
#endif
void FOR_NAME(uel, UEL)(double *rhs, double *amatrx, double *svars, double *energy, const int *ndofel, const int *nrhs,
    const int *nsvars, const double *props, const int *nprops, const double *coords, const int *mcrd, const int *nnode,
    const double *u)
{
    const double stiffness = props[0], force = stiffness * (u[1] - u[0]);
    rhs[0] = force;
    rhs[1] = -force;
    amatrx[0] = amatrx[3] = stiffness;
    amatrx[1] = amatrx[2] = -stiffness;
}
