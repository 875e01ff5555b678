// The kernels of this instruction set.
#include "sim/wide/kernels.h"
#include "sim/wide/simd.h"

const SimWide WIDE(sim_wide) = {
    .name = SIM_ISA_NAME,
    .list_block = WIDE(sim_list_block),
    .pbf_inherit = WIDE(sim_pbf_inherit),
    .pbf_start = WIDE(sim_pbf_start),
    .pbf_density = WIDE(sim_pbf_density),
    .pbf_correct = WIDE(sim_pbf_correct),
    .sph_density = WIDE(sim_sph_density),
    .sph_force = WIDE(sim_sph_force),
    .diffuse = WIDE(sim_diffuse),
    .tension_normal = WIDE(sim_tension_normal),
    .tension_force = WIDE(sim_tension_force),
    .vorticity_curl = WIDE(sim_vorticity_curl),
    .vorticity_confine = WIDE(sim_vorticity_confine),
    .surface_sweep = WIDE(sim_surface_sweep),
    .surface_density = WIDE(sim_surface_density),
    .surface_ellipsoids = WIDE(sim_surface_ellipsoids),
    .surface_heights = WIDE(sim_surface_heights),
    .machine_fma = WIDE(sim_machine_fma),
};
