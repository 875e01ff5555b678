// A surface of superposed waves: see ripple.h. Airy's linear waves (Lamb, Hydrodynamics, 1932, §228–229):
//
//   y(x, t) = level + Σ A cos(k·x − ω t + φ)          travelling along k
//   y(x, t) = level + Σ A cos(k·x + φ) cos(ω t)       standing
//   ω² = g k tanh(k d)                                 k = 2π/wavelength, d the depth of water at rest
//
// The slope is the derivative, − Σ A k sin(…), and the normal (−∂y/∂x, 1, −∂y/∂z) made a unit vector.
//
// Along a row of nodes each wave's phase grows by the same angle, so its cosine and sine are turned by a constant rotation: in
// double precision that is off by 10⁻¹² at the end of the longest row.
#include "sim/ripple.h"

#include <math.h>

#include "sim/parallel.h"
#include "sim/surface.h"
#include "sim/world.h"

#define PI 3.14159265358979323846

#define NODES_A_WAVE 20 // the shortest one
#define NODES_A_SIDE 32 // at least, of the longer side
#define MOST_NODES_A_SIDE 512

double sim_wave_frequency(double wavelength, double gravity, double depth) {
  double k = 2 * PI / wavelength;
  return sqrt(gravity * k * tanh(k * depth));
}

// ---- Limits ----------------------------------------------------------------------------------------------------------

static bool check_wave(const SimWaveDef *wave, int32_t index, float spacing, SimError *error) {
  if (!(wave->amplitude >= 0 && wave->amplitude <= 1e3f))
    return sim_fail(error, "waves[%d].amplitude must be in [0, 1000] m, got %g", index, (double)wave->amplitude);
  if (!(wave->wavelength >= spacing && wave->wavelength <= 1e6f))
    return sim_fail(error, "waves[%d].wavelength must be in [%g, 1e6] m, from one spacing on, got %g", index,
                    (double)spacing, (double)wave->wavelength);
  float length = hypotf(wave->direction[0], wave->direction[1]);
  if (!(length > 1e-10f && length <= 1e10f))
    return sim_fail(error, "waves[%d].direction must be finite and not zero", index);
  if (!(fabsf(wave->phase) <= 1e4f))
    return sim_fail(error, "waves[%d].phase must be in [-10000, 10000] rad, got %g", index, (double)wave->phase);
  return true;
}

static bool check_particles(const SimWorldDef *def, SimError *error) {
  if (def->block_count > 0 || def->drop_count > 0 || def->emitter_count > 0 || def->sink_count > 0)
    return sim_fail(error, "a ripple has no particles: no blocks, drops, emitters or sinks beside it");
  for (int32_t b = 0; b < def->obstacle_count; b++)
    if (def->obstacles[b].motion == SIM_FLOATING)
      return sim_fail(error, "obstacles[%d]: nothing floats on a ripple, it has no particles to carry it", b);
  return true;
}

bool sim_ripple_check(const SimWorldDef *def, SimError *error) {
  if (!def->ripple) {
    if (def->wave_count == 0) return true;
    return sim_fail(error, "waves need ripple to be set");
  }
  if (def->wave_count < 0 || def->wave_count > SIM_MAX_WAVES || (def->wave_count > 0 && !def->waves))
    return sim_fail(error, "waves: count must be in [0, %d], got %d%s", SIM_MAX_WAVES, def->wave_count,
                    def->waves || def->wave_count == 0 ? "" : " and no array");
  if (!(def->gravity[1] < 0))
    return sim_fail(error, "gravity must point downwards for a ripple, got %g m/s² along y", (double)def->gravity[1]);
  double highest = (double)def->ripple_level, lowest = highest;
  for (int32_t w = 0; w < def->wave_count; w++) {
    if (!check_wave(&def->waves[w], w, 2 * def->particle_radius, error)) return false;
    highest += (double)def->waves[w].amplitude, lowest -= (double)def->waves[w].amplitude;
  }
  const SimContainer *box = &def->container;
  if (!(lowest > (double)box->min[1] && highest < (double)box->max[1]))
    return sim_fail(
        error,
        "ripple_level, %g m, and all amplitudes together must stay between %g and %g m, floor and lid, got %g to %g",
        (double)def->ripple_level, (double)box->min[1], (double)box->max[1], lowest, highest);
  return check_particles(def, error);
}

// ---- At a moment -----------------------------------------------------------------------------------------------------

void sim_ripple_at(const SimWorldDef *def, double time, SimRipple *ripple) {
  double gravity = -(double)def->gravity[1], depth = (double)def->ripple_level - (double)def->container.min[1];
  ripple->level = (double)def->ripple_level;
  ripple->wave_count = def->wave_count;
  for (int32_t w = 0; w < def->wave_count; w++) {
    const SimWaveDef *wave = &def->waves[w];
    double along = (double)wave->direction[0], across = (double)wave->direction[1], length = hypot(along, across);
    double k = 2 * PI / (double)wave->wavelength;
    double turn = fmod(sim_wave_frequency((double)wave->wavelength, gravity, depth) * time, 2 * PI);
    ripple->wave[w] = (SimRippleWave){.amplitude = (double)wave->amplitude * (wave->standing ? cos(turn) : 1),
                                      .k = {k * along / length, k * across / length},
                                      .angle = (double)wave->phase - (wave->standing ? 0 : turn)};
  }
}

// ---- Nodes -----------------------------------------------------------------------------------------------------------

float sim_ripple_spacing(const SimWorldDef *def) {
  const SimContainer *box = &def->container;
  float longer = fmaxf(box->max[0] - box->min[0], box->max[2] - box->min[2]), spacing = longer / NODES_A_SIDE;
  for (int32_t w = 0; w < def->wave_count; w++) spacing = fminf(spacing, def->waves[w].wavelength / NODES_A_WAVE);
  return fmaxf(spacing, longer / MOST_NODES_A_SIDE);
}

typedef struct RippleContext {
  const SimRipple *ripple;
  const SimHeightField *field;
  SimHeightContext glass;
  float floor, *height, *normal;
} RippleContext;

// What is turned from node to node of a row.
typedef struct Turning {
  double cosine, sine;           ///< of the phase at the node
  double step_cosine, step_sine; ///< of what it grows by
} Turning;

static void start_row(const RippleContext *c, double z, Turning turning[SIM_MAX_WAVES]) {
  for (int32_t w = 0; w < c->ripple->wave_count; w++) {
    const SimRippleWave *wave = &c->ripple->wave[w];
    double phase = wave->k[0] * (double)c->field->origin[0] + wave->k[1] * z + wave->angle;
    double step = wave->k[0] * (double)c->field->spacing;
    turning[w] = (Turning){cos(phase), sin(phase), cos(step), sin(step)};
  }
}

static void step_row(const RippleContext *c, Turning turning[SIM_MAX_WAVES]) {
  for (int32_t w = 0; w < c->ripple->wave_count; w++) {
    Turning *t = &turning[w];
    double cosine = t->cosine * t->step_cosine - t->sine * t->step_sine;
    t->sine = t->sine * t->step_cosine + t->cosine * t->step_sine;
    t->cosine = cosine;
  }
}

static void write_node(const RippleContext *c, const Turning turning[SIM_MAX_WAVES], int64_t node) {
  double height = c->ripple->level, slope[2] = {0, 0};
  for (int32_t w = 0; w < c->ripple->wave_count; w++) {
    const SimRippleWave *wave = &c->ripple->wave[w];
    height += wave->amplitude * turning[w].cosine;
    for (int k = 0; k < 2; k++) slope[k] -= wave->amplitude * wave->k[k] * turning[w].sine;
  }
  double length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
  c->height[node] = (float)height;
  c->normal[3 * node] = (float)(-slope[0] / length);
  c->normal[3 * node + 1] = (float)(1 / length);
  c->normal[3 * node + 2] = (float)(-slope[1] / length);
}

static void write_dry(const RippleContext *c, int64_t node) {
  c->height[node] = c->floor;
  c->normal[3 * node] = c->normal[3 * node + 2] = 0;
  c->normal[3 * node + 1] = 1;
}

static void row_kernel(int32_t begin, int32_t end, const void *context) {
  const RippleContext *c = context;
  const SimHeightField *f = c->field;
  Turning turning[SIM_MAX_WAVES];
  for (int32_t k = begin; k < end; k++) {
    float z = f->origin[1] + f->spacing * (float)k;
    start_row(c, (double)z, turning);
    for (int32_t i = 0; i < f->size[0]; i++, step_row(c, turning)) {
      int64_t node = (int64_t)k * f->size[0] + i;
      if (sim_height_beyond(&c->glass, f->origin[0] + f->spacing * (float)i, z))
        write_dry(c, node);
      else
        write_node(c, turning, node);
    }
  }
}

void sim_ripple_heights(const SimRipple *ripple, const SimContainer *container, const SimHeightField *field,
                        float floor, int32_t threads, float *height, float *normal) {
  RippleContext context = {ripple, field, {.field = field}, floor, height, normal};
  context.glass.glass = sim_height_glass(container, context.glass.axis);
  sim_parallel_tasks(threads, field->size[1], row_kernel, &context);
}
