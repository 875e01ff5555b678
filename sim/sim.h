// Lido's simulator: water made of particles (position based fluids), and the surface stages that turn any set of
// particles into a frame that can be drawn.
//
// Plain C17, libm and OpenMP; no OpenGL, no files, no window. SI units, y up.
//
//   SimWorldDef def = sim_default_world_def();     // every Def comes from its default function
//   def.block_count = 1; def.blocks = &block;
//   SimError error;
//   SimWorld *world = sim_world_create(&def, &error);
//   SimFrameBuffer *buffer = sim_frame_buffer_create();
//   while (sim_world_advance(world, 1.0 / 60, &error)) {
//     const SimFrame *frame = sim_world_frame(world, SIM_NEED_ANISOTROPY, buffer, &error);
//     …
//   }
//
// Determinism: the same Def and the same calls give the same bytes, for any number of threads.
// Threads: one world is used by one thread at a time. Different worlds and different frame buffers are independent, so
// frame n can be drawn from one buffer while frame n + 1 is simulated and written to a second one.
#ifndef LIDO_SIM_SIM_H
#define LIDO_SIM_SIM_H

#include <stddef.h>

#include "sim/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SIM_VERSION_STRING "0.1.0"

/// Largest number of particles of one world or particle set. More is refused with an error, not tried.
#define SIM_MAX_PARTICLES (16 * 1024 * 1024)

/// Why a call failed: one line without a newline, fit to be shown to a person.
typedef struct SimError { char message[256]; } SimError;

// ---- A world ---------------------------------------------------------------------------------------------------------

typedef enum SimSolver { SIM_SOLVER_PBF = 0 } SimSolver;

/// A block of water, filled with a cubic lattice of particles at the start.
typedef struct SimBlockDef {
  float min[3], max[3];        ///< m, min < max
  float velocity[3];           ///< m/s at the start, default 0
  float colour[3];             ///< linear light [0, 1]; all zero: the default colour of water
} SimBlockDef;

/// Everything that a world is made of. Make it with sim_default_world_def, change what you need.
typedef struct SimWorldDef {
  uint32_t cookie;             ///< set by sim_default_world_def; a Def made otherwise is refused
  SimSolver solver;            ///< default SIM_SOLVER_PBF
  float particle_radius;       ///< m, half the spacing at rest, default 0.0175, range [1e-4, 1]
  float rest_density;          ///< kg/m³, default 1000, range [1, 1e5]
  float support;               ///< support radius h in spacings, default 2, range [1.5, 3]
  float gravity[3];            ///< m/s², default (0, −9.81, 0)
  float time_step;             ///< s, the longest substep; 0 (the default): adaptive, from `cfl`
  float cfl;                   ///< adaptive step: the fastest particle moves at most this many spacings a substep,
                               ///< default 0.4, range [0.05, 2]
  int32_t iterations;          ///< density iterations a substep, default 4, range [1, 100]
  float viscosity;             ///< XSPH factor c, non-dimensional, default 0.01, range [0, 0.5] (Macklin & Müller, Eq. 17)
  float relaxation;            ///< ε_rel of the constraint, non-dimensional, default 0.1, range [1e-3, 10] (Eq. 11)
  float tensile;               ///< k_rel of the artificial pressure, non-dimensional, default 0.003, range [0, 0.1] (Eq. 13)
  SimContainer container;      ///< default: 3 × 1.6 × 1 m, corner at the origin
  int32_t block_count;
  const SimBlockDef *blocks;   ///< (block_count), copied
  int32_t obstacle_count;
  const SimObstacle *obstacles;///< (obstacle_count), copied
  uint64_t seed;               ///< of every random choice, default 1
  float jitter;                ///< displacement of the start lattice, in spacings, default 0, range [0, 0.5]
  int32_t threads;             ///< 0 (the default): as many as there are cores
} SimWorldDef;

typedef struct SimWorld SimWorld;

SimWorldDef sim_default_world_def(void);

/// Make a world. Particles of a block that would lie in an obstacle or outside the container are left out; see
/// sim_world_counts. NULL and *error when a value is out of range, the particles are too many, or memory runs out.
SimWorld *sim_world_create(const SimWorldDef *def, SimError *error);
void sim_world_destroy(SimWorld *world); ///< NULL is allowed

/// Advance by `duration` seconds (> 0), in as many substeps as it takes.
/// false and *error when the step became invalid (NaN, explosion): the message names particle and stage, the world
/// keeps the last good state and every later call fails alike.
bool sim_world_advance(SimWorld *world, double duration, SimError *error);

/// Back to the start; as good as a new world.
void sim_world_reset(SimWorld *world);

/// A push as if by a hand: a ray into the water accelerates what is near it, fully on the ray and falling smoothly to
/// nothing at `radius`. It acts during the next sim_world_advance only; give it again for each frame it lasts.
typedef struct SimPush {
  float origin[3];             ///< m, a point on the ray
  float direction[3];          ///< unit, along the ray
  float radius;                ///< m, > 0
  float acceleration[3];       ///< m/s² on the ray itself
} SimPush;

/// At most SIM_MAX_PUSHES pushes act in one advance; false when there is no more room or a value is not finite.
#define SIM_MAX_PUSHES 16
bool sim_world_push(SimWorld *world, const SimPush *push);

/// Gravity from now on, m/s² (tilting the tank). Refused (false) unless finite.
bool sim_world_set_gravity(SimWorld *world, const float gravity[3]);

/// Pour a block of water into the running world. Lattice points that are nearer than 0.9 spacings to a particle, or
/// lie outside, stay empty. Returns the number of particles added, −1 and *error when it cannot.
int32_t sim_world_pour(SimWorld *world, const SimBlockDef *block, SimError *error);

/// Write the present state to a frame. The frame belongs to `buffer`. NULL and *error when memory runs out.
typedef struct SimFrameBuffer SimFrameBuffer;
const SimFrame *sim_world_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer, SimError *error);

/// What happened at creation and until now.
typedef struct SimCounts {
  int32_t particles;
  int32_t left_out;            ///< start-up particles that lay in an obstacle or outside the container
  int64_t substeps;            ///< since creation or reset
} SimCounts;
SimCounts sim_world_counts(const SimWorld *world);

/// Physical measures of the present state, for --stats and for tests.
typedef struct SimMeasures {
  double kinetic_energy;       ///< J
  double potential_energy;     ///< J, −m g·(x − container.min)
  double momentum[3];          ///< kg m/s
  double mean_density_error;   ///< mean |ρ − ρ0|/ρ0 over particles away from the free surface; 0 when there are none
  double max_density_error;    ///< largest of the same
  double max_speed;            ///< m/s
} SimMeasures;
SimMeasures sim_world_measures(SimWorld *world);

// ---- Particles that were not simulated here ----------------------------------------------------------------------------

/// A set of particles as a file holds them. Arrays that are NULL are estimated or left out.
typedef struct SimParticleSet {
  int64_t index; double time;  ///< handed on to the frame
  int32_t count;
  const float *position;       ///< m, (count, 3), required
  const float *velocity;       ///< m/s, (count, 3) or NULL: zero
  const float *colour;         ///< linear, (count, 3) or NULL
  const float *radius;         ///< m, (count) or NULL
  const uint8_t *particle_class; ///< SimClass, (count) or NULL: computed
  const uint32_t *id;          ///< (count) or NULL: 0, 1, 2 …
  float particle_radius;       ///< m; 0: estimated from the spacing (sim_estimate_radius)
  const SimContainer *container; ///< or NULL: the bounds
} SimParticleSet;

/// The same surface stages on any particle set. NULL and *error: a position is not finite, too many, no memory.
const SimFrame *sim_frame_from_particles(const SimParticleSet *set, unsigned needs, int32_t threads,
                                         SimFrameBuffer *buffer, SimError *error);

/// Half the typical distance of nearest neighbours (median over a fixed sample), m; 0.01 when there are fewer than two.
float sim_estimate_radius(const float *position, int32_t count);

SimFrameBuffer *sim_frame_buffer_create(void); ///< NULL when memory runs out
void sim_frame_buffer_destroy(SimFrameBuffer *buffer); ///< NULL is allowed

// ---- Measuring -----------------------------------------------------------------------------------------------------------

/// Stages of a step and of a frame, in the order in which they run.
#define SIM_STAGES(X) \
  X(predict) X(sort) X(neighbours) X(boundary) X(density) X(correct) X(velocity) X(viscosity) \
  X(frame) X(classify) X(anisotropy) X(flags) X(height_field)
typedef enum SimStage {
#define SIM_STAGE_ENUM(name) SIM_STAGE_##name,
  SIM_STAGES(SIM_STAGE_ENUM)
#undef SIM_STAGE_ENUM
  SIM_STAGE_COUNT
} SimStage;
const char *sim_stage_name(SimStage stage);

/// Milliseconds of wall time per stage, and the substeps and neighbour pairs they stand for, since
/// sim_world_clear_profile.
typedef struct SimProfile {
  double milliseconds[SIM_STAGE_COUNT];
  int64_t substeps;
  int64_t neighbour_pairs;     ///< fluid–fluid pairs (i, j) with i ≠ j inside the support, each counted twice
} SimProfile;
const SimProfile *sim_world_profile(const SimWorld *world);
void sim_world_clear_profile(SimWorld *world);

/// Bytes and blocks that the library holds now, over all worlds and buffers; both 0 after the last destroy.
size_t sim_bytes_in_use(void);
size_t sim_allocation_count(void); ///< allocations made so far: a warm step makes none

#ifdef __cplusplus
}
#endif
#endif
