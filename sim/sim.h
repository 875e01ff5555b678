// Lido's simulator: water made of particles (position based fluids, or SPH), and the surface stages that turn any set of
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

/// Largest number of particles of one world, and of a particle set, which may be more than a world could make. More is
/// refused with an error, not tried.
#define SIM_MAX_PARTICLES (16 * 1024 * 1024)
#define SIM_MAX_SET_PARTICLES (256 * 1024 * 1024)

/// Why a call failed: one line without a newline, fit to be shown to a person.
typedef struct SimError { char message[256]; } SimError;

// ---- A world ---------------------------------------------------------------------------------------------------------

typedef enum SimSolver { SIM_SOLVER_PBF = 0, SIM_SOLVER_SPH = 1 } SimSolver;

/// A block of water, filled with a lattice of particles: cubic where whole spacings fit, else stretched or squeezed a little along
/// its axes, so that it reaches from side to side and the number of particles is nearly that of the block's volume.
typedef struct SimBlockDef {
  float min[3], max[3];        ///< m, min < max
  float velocity[3];           ///< m/s at the start, default 0
  float colour[3];             ///< linear light [0, 1]; all zero: the default colour of water
} SimBlockDef;

/// The particles that a block holds where nothing is in the way; a huge block many more than there may be.
double sim_block_particles(const SimBlockDef *block, float particle_radius);

/// A ball of water, cut out of a cubic lattice that lies symmetrically about its centre.
typedef struct SimDropDef {
  float centre[3], radius;     ///< m, radius > 0
  float velocity[3];           ///< m/s at the start
  float colour[3];             ///< as for a block
} SimDropDef;

typedef enum SimEmitterShape { SIM_EMITTER_DISC = 0, SIM_EMITTER_RECTANGLE = 1 } SimEmitterShape;

/// A spout: layers of particles leave its opening, one whenever the last one is about a spacing away: just so far that the
/// flow is the opening's area times the speed. A layer's particles begin half a spacing in front of the opening, so it may
/// lie in a wall. A place that is not free (a body, other water) emits nothing until it is.
typedef struct SimEmitterDef {
  SimEmitterShape shape;
  float size[2];               ///< m: disc, (diameter, –); rectangle, full width along its first and second axis; at most 2²⁰
                               ///< particles a layer
  float position[3];           ///< m, the middle of the opening; in the obstacle's own axes where `obstacle` is set
  float rotation[4];           ///< unit quaternion x, y, z, w; water leaves along the turned +x axis, the rectangle's first
                               ///< axis is the turned y
  float speed;                 ///< m/s, [0.01, 100], on top of the obstacle's
  double start, stop;          ///< s: it runs from start until stop, start ≤ stop; stop may be INFINITY
  float colour[3];             ///< as for a block
  int32_t obstacle;            ///< index of the obstacle that carries it, −1: none
} SimEmitterDef;

/// A disc of 10 cm at the origin, 1 m/s along x, without end.
SimEmitterDef sim_default_emitter_def(void);

/// A box that swallows the particles whose centres enter it.
typedef struct SimSinkDef {
  float min[3], max[3];        ///< m, min < max
} SimSinkDef;

/// A wave on a ripple's surface: a small one on water of the ripple's depth d, ω² = g k tanh(k d), k = 2π/wavelength.
typedef struct SimWaveDef {
  float amplitude;             ///< m, half the height from trough to crest, [0, 1000]
  float wavelength;            ///< m, [two particle radii, 1e6]
  float direction[2];          ///< along x and z, where it goes to; any length but 0
  float phase;                 ///< rad, of the cosine at the origin at time 0
  bool standing;               ///< it swings where it is: amplitude · cos(k·x + phase) · cos(ω t)
} SimWaveDef;
#define SIM_MAX_WAVES 64

typedef enum SimMotion {
  SIM_STATIC = 0,
  SIM_SCRIPTED = 1,            ///< follows its keys and its stroke, whatever the water does
  SIM_DRAGGABLE = 2,           ///< goes to where sim_world_drag wants it, not faster than max_speed
  SIM_FLOATING = 3             ///< a rigid body: gravity, the water, the container and other bodies move it
} SimMotion;

/// A pose at a moment. Between keys, positions are interpolated linearly and rotations spherically; before the first and
/// after the last key the pose stays.
typedef struct SimPoseKey {
  double time;                 ///< s, growing from key to key
  float position[3];           ///< m
  float rotation[4];           ///< unit quaternion x, y, z, w
} SimPoseKey;

/// A body and how it moves.
typedef struct SimObstacleDef {
  SimObstacle body;            ///< shape, and the pose at the start
  SimMotion motion;
  float friction;              ///< share of the sliding speed that the wall takes from the layer of water beside it on a way of
                               ///< one spacing (friction.c): 0 slips freely, 1 sticks; [0, 1]
  // SIM_SCRIPTED: pose(t) = that of the keys (the start's where there are none) + stroke · (1 − cos(2π (t − start)/period))/2
  int32_t key_count;
  const SimPoseKey *keys;      ///< (key_count), copied
  bool repeat;                 ///< the keys start again after the last one
  float stroke[3];             ///< m, the paddle's way from its start to its turning point; 0: none
  float period;                ///< s, > 0 where there is a stroke
  double start;                ///< s, the paddle stands still before
  // SIM_DRAGGABLE
  float max_speed;             ///< m/s, > 0; also the bound on the speed of its farthest corner when it turns
  // SIM_FLOATING
  float density;               ///< kg/m³, > 0
} SimObstacleDef;

SimObstacleDef sim_default_obstacle_def(void); ///< a static box of 1 m without friction

/// Everything that a world is made of. Make it with sim_default_world_def, change what you need.
typedef struct SimWorldDef {
  uint32_t cookie;             ///< set by sim_default_world_def; a Def made otherwise is refused
  SimSolver solver;            ///< default SIM_SOLVER_PBF
  float particle_radius;       ///< m, half the spacing at rest, default 0.0175, range [1e-4, 1]
  float rest_density;          ///< kg/m³, default 1000, range [1, 1e5]
  float support;               ///< support radius h in spacings, default 2, range [1.5, 3]
  float gravity[3];            ///< m/s², default (0, −9.81, 0)
  float time_step;             ///< s, the longest substep; 0 (the default): adaptive, from `cfl`
  float cfl;                   ///< adaptive step: the fastest particle moves at most this many spacings a substep, half as many
                               ///< again in free flight, default 1.1, range [0.05, 2]
  int32_t iterations;          ///< density iterations a substep, default 4, range [1, 100]; the last of several moves
                               ///< particles without changing their velocity (solver_pbf.h)
  float viscosity;             ///< XSPH factor c, non-dimensional, default 0.04, range [0, 0.5] (Macklin & Müller, Eq. 17): the
                               ///< share in a time of 0.1 √(spacing/gravity); in a substep where there is no gravity
  float kinematic_viscosity;   ///< m²/s, ν of the liquid, default 1e-6 (water), range [0, 10]
  float surface_tension;       ///< N/m, default 0, range [0, 10] (Akinci et al. 2013; tension.h)
  float vorticity;             ///< vorticity confinement ε, non-dimensional (vorticity.c), default 0, range [0, 1] (Macklin &
                               ///< Müller, Eq. 16)
  float relaxation;            ///< ε_rel of the constraint, non-dimensional, default 0.1, range [1e-3, 10] (Eq. 11)
  float tensile;               ///< k_rel of the artificial pressure, non-dimensional, default 0, range [0, 0.1] (Eq. 13)
  SimContainer container;      ///< default: 3 × 1.6 × 1 m, corner at the origin
  int32_t block_count;
  const SimBlockDef *blocks;   ///< (block_count), copied
  float container_friction;    ///< of the container's walls, as SimObstacleDef.friction, default 0
  int32_t drop_count;
  const SimDropDef *drops;     ///< (drop_count), copied
  int32_t emitter_count;
  const SimEmitterDef *emitters; ///< (emitter_count), copied
  int32_t sink_count;
  const SimSinkDef *sinks;     ///< (sink_count), copied
  int32_t max_particles;       ///< emitters and pouring stop there, and a start with more is refused, [0, SIM_MAX_PARTICLES];
                               ///< 0 (the default): SIM_MAX_PARTICLES. Memory for them is set aside where there are emitters
  bool reuse;                  ///< at max_particles emitters and pouring take away the particles that came first, never those
                               ///< of the start; default false
  bool ripple;                 ///< the water is a sum of waves and has no particles: frames have a height field only. No blocks,
                               ///< drops, emitters, sinks or floating obstacles beside it. Default false
  float ripple_level;          ///< m, y of its surface at rest; waves must neither reach the floor nor the container's upper end
  int32_t wave_count;          ///< [0, SIM_MAX_WAVES]
  const SimWaveDef *waves;     ///< (wave_count), copied
  float colour_diffusion;      ///< m²/s, how fast colours of neighbouring water mix, default 0, range [0, 10]
  int32_t obstacle_count;
  const SimObstacleDef *obstacles; ///< (obstacle_count), copied, their meshes too
  uint64_t seed;               ///< of every random choice, default 1
  float jitter;                ///< displacement of the start lattice, in spacings, default 0, range [0, 0.5]
  int32_t threads;             ///< 0 (the default): as many as there are cores
} SimWorldDef;

typedef struct SimWorld SimWorld;

SimWorldDef sim_default_world_def(void);

/// Make a world. Particles of a block or drop that would lie in an obstacle or outside the container are left out; see
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
/// The same with a ball of water.
int32_t sim_world_drop(SimWorld *world, const SimDropDef *drop, SimError *error);

/// Open or close an emitter; open, it still runs from its start until its stop only. All are open at the start and after a
/// reset. false: no such emitter.
bool sim_world_set_emitter(SimWorld *world, int32_t emitter, bool on);

/// Where the draggable obstacle should be from now on; it goes there at no more than its max_speed, so that nothing
/// tunnels. false: no such draggable obstacle, or not finite. Rotation NULL: as it is.
bool sim_world_drag(SimWorld *world, int32_t obstacle, const float position[3], const float rotation[4]);

/// Write the present state to a frame. The frame belongs to `buffer`. NULL and *error when memory runs out.
typedef struct SimFrameBuffer SimFrameBuffer;
const SimFrame *sim_world_frame(SimWorld *world, unsigned needs, SimFrameBuffer *buffer, SimError *error);

/// What happened at creation and until now.
typedef struct SimCounts {
  int32_t particles;
  int32_t left_out;            ///< start-up particles that lay in an obstacle, outside the container or in other water
  int64_t emitted, swallowed, reused; ///< by emitters and pouring; by sinks; taken away at max_particles
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
  double body_momentum[3];     ///< kg m/s, of the floating bodies
  double body_energy;          ///< J, of the floating bodies, kinetic and potential
} SimMeasures;
SimMeasures sim_world_measures(SimWorld *world);

// ---- Particles that were not simulated here ----------------------------------------------------------------------------

/// A set of particles as a file holds them. Arrays that are NULL are estimated or left out.
typedef struct SimParticleSet {
  int64_t index; double time;  ///< handed on to the frame
  int32_t count;
  const float *position;       ///< m, (count, 3), required
  const float *velocity;       ///< m/s, (count, 3) or NULL: the frame has none either
  const float *colour;         ///< linear, (count, 3) or NULL
  const float *radius;         ///< m, (count) or NULL
  const uint8_t *particle_class; ///< SimClass, (count) or NULL: computed
  const uint32_t *id;          ///< (count) or NULL: 0, 1, 2 …
  float particle_radius;       ///< m; 0: estimated from the spacing (sim_estimate_radius)
  const SimContainer *container; ///< or NULL: the bounds
} SimParticleSet;

/// The same surface stages on any particle set. Without any need a frame takes 20 bytes a particle and 1 (water) to 2
/// (drops scattered in much room) for its grid; ids, velocities, colours and densities come on top, surface stages take
/// about 200 more. NULL and *error: a position is not finite, too many, no memory.
const SimFrame *sim_frame_from_particles(const SimParticleSet *set, unsigned needs, int32_t threads,
                                         SimFrameBuffer *buffer, SimError *error);

/// Half the typical distance of nearest neighbours (median over a fixed sample), m; 0.01 when there are fewer than two.
float sim_estimate_radius(const float *position, int32_t count);

SimFrameBuffer *sim_frame_buffer_create(void); ///< NULL when memory runs out
void sim_frame_buffer_destroy(SimFrameBuffer *buffer); ///< NULL is allowed

// ---- Measuring -----------------------------------------------------------------------------------------------------------

/// Stages of a step and of a frame, in the order in which they run. `classify` is the sweep over the neighbours that
/// anisotropy and flags need too.
#define SIM_STAGES(X) \
  X(predict) X(sort) X(neighbours) X(tension) X(warm_start) X(density) X(correct) X(velocity) X(vorticity) X(viscosity) X(mix) \
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

/// What this machine can do at best, to hold the figures of a profile against.
typedef struct SimMachine {
  const char *instruction_set; ///< that the simulator's kernels use here: "avx512", "avx2", "sse2" or "scalar"
  double fma_per_second;       ///< single-precision multiply-adds, all threads together
  double copy_per_second;      ///< bytes read plus bytes written by a copy much larger than the caches, all threads together
} SimMachine;

/// Measure it now, in about half a second. false and *error when memory runs out.
bool sim_measure_machine(int32_t threads, SimMachine *machine, SimError *error);

/// Bytes and blocks that the library holds now, over all worlds and buffers; both 0 after the last destroy.
size_t sim_bytes_in_use(void);
size_t sim_allocation_count(void); ///< allocations made so far: a warm step makes none

#ifdef __cplusplus
}
#endif
#endif
