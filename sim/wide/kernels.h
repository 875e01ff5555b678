// The kernels that table.c collects; every file in this folder defines some. See wide.h.
#ifndef LIDO_SIM_WIDE_KERNELS_H
#define LIDO_SIM_WIDE_KERNELS_H

#include "sim/wide/simd.h"

extern const SimWide WIDE(sim_wide);

void WIDE(sim_list_block)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_pbf_inherit)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_pbf_start)(int32_t begin, int32_t end, const void *context, double *partial);
void WIDE(sim_pbf_density)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_pbf_correct)(int32_t begin, int32_t end, const void *context, double *partial);
void WIDE(sim_sph_density)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_sph_force)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_diffuse)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_tension_normal)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_tension_force)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_vorticity_curl)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_vorticity_confine)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_surface_sweep)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_surface_density)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_surface_ellipsoids)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_surface_heights)(int32_t begin, int32_t end, const void *context);
void WIDE(sim_machine_fma)(int32_t begin, int32_t end, const void *context);

#endif
