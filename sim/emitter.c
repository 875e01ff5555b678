// Emitters: layers of particles leave an opening whenever the stream has gone far enough.
//
// The inflow by layers that particle codes usually have (there is no one paper to name), with three things settled here.
//
// Volume. A layer is a square lattice cut to the opening. Its n points seldom stand for exactly the opening's area A at
// one spacing s, and a rate that is off by n s²/A would be wrong by several per cent for a narrow spout. So the lattice is
// stretched in the plane until its points fill A, and the pitch from layer to layer is p = n s³/A: then every particle
// still has the volume s³ of the lattice at rest, so the density is the one at rest, and the flow is exactly A · speed.
// Stretch and pitch differ from 1 by a few per cent, but where the opening is narrower than a spacing, n = 1 and the
// stream is a chain of particles or drips. Layers are not staggered: the cubic lattice is the one whose density sum is 1.
//
// Time. The front of the stream leaves the opening at `start`; layer k is due when it has wholly left, that is when the
// front has gone (k + 1) p. Then its centres are half a spacing ahead, where an opening that lies in a wall leaves room for
// them. Substeps do not end just then: a layer that was due a while τ before the end of a substep is placed speed · τ
// farther ahead, so that the stream has neither gaps nor bunches whatever the substeps. (What gravity does to it within τ
// is left out: at most REST_MOVE of world.c, in spacings.)
//
// Guidance. The last layer would be a free surface, with nothing behind that holds it, as the water in a pipe does: the
// solver pushes it back (the artificial pressure alone takes half its speed), the next one finds its places taken, and the
// stream is torn. So as long as a layer is nearer to the opening than the support radius, its particles are put back at the
// end of each substep to where the stream should be, with the stream's velocity: a piston. Released layers have all their
// neighbours, at their places. (Tafuni et al., A versatile algorithm for the treatment of open boundary conditions in
// smoothed particle hydrodynamics GPU models, 2018, hold the layers of an inflow likewise, but outside of the domain.)
//
// Free places. A place stays empty when it touches a wall or a body or is nearer than 0.9 spacings to a particle that is
// not guided. A guided particle whose place a body takes is left to itself. A body that carries an emitter feels no recoil.
#include "sim/emitter.h"

#include <math.h>
#include <string.h>

#include "sim/memory.h"
#include "sim/world.h"

// A place nearer than this to a particle, in spacings, stays empty.
#define TOO_NEAR 0.9f

SimEmitterDef sim_default_emitter_def(void) {
  return (SimEmitterDef){.shape = SIM_EMITTER_DISC,
                         .size = {0.1f, 0.1f},
                         .rotation = {0, 0, 0, 1},
                         .speed = 1,
                         .stop = INFINITY,
                         .obstacle = -1};
}

// ---- The places of a layer -------------------------------------------------------------------------------------------

/// A square lattice in units of spacings: a point in the middle of the opening, or the middle between two, along each axis.
typedef struct Pattern {
  int32_t size[2]; ///< points along each axis
  double radius2;  ///< of the disc that cuts it, or infinite
  int32_t count;
} Pattern;

static double pattern_coordinate(const Pattern *pattern, int axis, int32_t index) {
  return index - 0.5 * (pattern->size[axis] - 1);
}

static bool pattern_has(const Pattern *pattern, int32_t a, int32_t b) {
  double y = pattern_coordinate(pattern, 0, a), z = pattern_coordinate(pattern, 1, b);
  return y * y + z * z <= pattern->radius2;
}

static double area_of(const SimEmitterDef *def, double spacing) {
  double a = (double)def->size[0] / spacing, b = (double)def->size[1] / spacing;
  return def->shape == SIM_EMITTER_DISC ? 0.78539816339744831 * a * a : a * b;
}

double sim_emitter_places(const SimEmitterDef *def, float spacing) {
  if (def->shape == SIM_EMITTER_DISC) return fmax(1, area_of(def, (double)spacing));
  return fmax(1, round((double)def->size[0] / (double)spacing)) *
         fmax(1, round((double)def->size[1] / (double)spacing));
}

// Of the lattices with a point or a gap in the middle, the one whose number of points is nearest to the area.
static Pattern disc_pattern(double radius, double area) {
  Pattern best = {{1, 1}, 1, 1};
  int32_t odd = 2 * (int32_t)floor(radius) + 1, even = 2 * (int32_t)floor(radius + 0.5);
  const int32_t sizes[3][2] = {{odd, odd}, {even, even}, {even, odd}};
  for (int k = 0; k < 3; k++) {
    Pattern tried = {{sizes[k][0], sizes[k][1]}, radius * radius * 1.000001, 0};
    for (int32_t a = 0; a < tried.size[0]; a++)
      for (int32_t b = 0; b < tried.size[1]; b++) tried.count += pattern_has(&tried, a, b);
    if (tried.count > 0 && fabs(tried.count - area) < fabs(best.count - area)) best = tried;
  }
  return best;
}

static Pattern make_pattern(const SimEmitterDef *def, double spacing) {
  if (def->shape == SIM_EMITTER_DISC) return disc_pattern(0.5 * (double)def->size[0] / spacing, area_of(def, spacing));
  Pattern pattern = {{0, 0}, INFINITY, 0};
  for (int axis = 0; axis < 2; axis++) pattern.size[axis] = (int32_t)fmax(1, round((double)def->size[axis] / spacing));
  pattern.count = pattern.size[0] * pattern.size[1];
  return pattern;
}

static bool make_places(SimEmitter *emitter, const SimEmitterDef *def, float spacing) {
  Pattern pattern = make_pattern(def, (double)spacing);
  double area = area_of(def, (double)spacing), stretch = sqrt(area / pattern.count);
  double step[2] = {stretch * (double)spacing, stretch * (double)spacing};
  for (int axis = 0; axis < 2 && def->shape == SIM_EMITTER_RECTANGLE; axis++)
    step[axis] = (double)def->size[axis] / pattern.size[axis];
  emitter->place_count = pattern.count;
  emitter->pitch = (float)((double)spacing * pattern.count / area);
  emitter->place = sim_allocate(2 * sizeof(float) * (size_t)pattern.count);
  if (!emitter->place) return false;
  for (int axis = 0; axis < 2; axis++) {
    emitter->half[axis] = (float)(0.5 * step[axis] * (pattern.size[axis] - 1));
    emitter->cells[axis] = (int32_t)ceil(2 * (double)emitter->half[axis] / (double)spacing) + 2;
  }
  int32_t n = 0;
  for (int32_t a = 0; a < pattern.size[0]; a++)
    for (int32_t b = 0; b < pattern.size[1]; b++) {
      if (!pattern_has(&pattern, a, b)) continue;
      emitter->place[2 * n] = (float)(step[0] * pattern_coordinate(&pattern, 0, a));
      emitter->place[2 * n++ + 1] = (float)(step[1] * pattern_coordinate(&pattern, 1, b));
    }
  return true;
}

static bool make_layers(SimEmitter *emitter, float support) {
  emitter->layer_room = (int32_t)ceilf(support / emitter->pitch) + 1;
  emitter->layer = sim_allocate((size_t)emitter->layer_room * sizeof(SimLayer));
  for (int32_t k = 0; emitter->layer && k < emitter->layer_room; k++) {
    emitter->layer[k].place = sim_allocate(sizeof(int32_t) * (size_t)emitter->place_count);
    if (!emitter->layer[k].place) return false;
  }
  return emitter->layer != NULL;
}

bool sim_emitters_make(SimEmitters *emitters, const SimEmitterDef *defs, int32_t count, float spacing, float support) {
  size_t places = 0, cells = 0;
  if (count == 0) return true;
  emitters->emitter = sim_allocate((size_t)count * sizeof(SimEmitter));
  if (!emitters->emitter) return false;
  emitters->count = count;
  for (int32_t e = 0; e < count; e++) {
    SimEmitter *emitter = &emitters->emitter[e];
    if (!make_places(emitter, &defs[e], spacing) || !make_layers(emitter, support)) return false;
    size_t own = (size_t)emitter->cells[0] * (size_t)emitter->cells[1];
    if ((size_t)emitter->place_count > places) places = (size_t)emitter->place_count;
    if (own > cells) cells = own;
  }
  return sim_reserve((void **)&emitters->head, cells, sizeof(int32_t)) &&
         sim_reserve((void **)&emitters->open, places, sizeof(int32_t)) &&
         sim_reserve((void **)&emitters->nearby, 4 * places, sizeof(SimNearby));
}

void sim_emitters_free(SimEmitters *emitters) {
  for (int32_t e = 0; e < emitters->count; e++) {
    SimEmitter *emitter = &emitters->emitter[e];
    for (int32_t k = 0; emitter->layer && k < emitter->layer_room; k++) sim_release(emitter->layer[k].place);
    sim_release(emitter->layer);
    sim_release(emitter->place);
  }
  sim_release(emitters->emitter);
  sim_release(emitters->head);
  sim_release(emitters->open);
  sim_release(emitters->nearby);
  memset(emitters, 0, sizeof *emitters);
}

void sim_emitters_reset(SimEmitters *emitters) {
  for (int32_t e = 0; e < emitters->count; e++) {
    SimEmitter *emitter = &emitters->emitter[e];
    emitter->on = true;
    emitter->clock = emitter->way = 0;
    emitter->guided = 0;
  }
}

// ---- Where a layer leaves --------------------------------------------------------------------------------------------

/// Where a layer is in the world: the middle of it, the opening's axes, and how it moves.
typedef struct Opening {
  float centre[3];   ///< m
  float axis[3][3];  ///< axis[0] is the way the water goes
  float velocity[3]; ///< m/s, at the centre
  float spin[3];     ///< rad/s
} Opening;

static void cross(const float a[3], const float b[3], float c[3]) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

// v + 2 w (q × v) + 2 q × (q × v), with the quaternion normalised.
static void turn(const float rotation[4], float v[3]) {
  float t[3], u[3], length2 = 0;
  for (int k = 0; k < 4; k++) length2 += rotation[k] * rotation[k];
  float scale = 1 / sqrtf(length2), q[3] = {rotation[0] * scale, rotation[1] * scale, rotation[2] * scale};
  cross(q, v, t);
  cross(q, t, u);
  for (int k = 0; k < 3; k++) v[k] += 2 * (rotation[3] * scale * t[k] + u[k]);
}

static Opening opening_at(const SimWorld *world, const SimEmitterDef *def, double ahead) {
  Opening layer = {.axis = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  memcpy(layer.centre, def->position, sizeof layer.centre);
  for (int a = 0; a < 3; a++) turn(def->rotation, layer.axis[a]);
  if (def->obstacle >= 0) {
    const SimObstacle *carrier = &world->obstacles[def->obstacle];
    turn(carrier->rotation, layer.centre);
    for (int a = 0; a < 3; a++) turn(carrier->rotation, layer.axis[a]);
    for (int k = 0; k < 3; k++) layer.centre[k] += carrier->position[k];
  }
  for (int k = 0; k < 3; k++) layer.centre[k] += (0.5f * world->cubic.spacing + (float)ahead) * layer.axis[0][k];
  if (def->obstacle >= 0 && world->bodies[def->obstacle].moves) {
    const SimBody *body = &world->bodies[def->obstacle];
    float arm[3], swing[3];
    for (int k = 0; k < 3; k++) arm[k] = layer.centre[k] - body->position[k];
    cross(body->spin, arm, swing);
    for (int k = 0; k < 3; k++) layer.velocity[k] = body->velocity[k] + swing[k];
    memcpy(layer.spin, body->spin, sizeof layer.spin);
  }
  for (int k = 0; k < 3; k++) layer.velocity[k] += def->speed * layer.axis[0][k];
  return layer;
}

static void place_in_world(const Opening *layer, const float place[2], float point[3], float velocity[3]) {
  float arm[3], swing[3];
  for (int k = 0; k < 3; k++) arm[k] = place[0] * layer->axis[1][k] + place[1] * layer->axis[2][k];
  cross(layer->spin, arm, swing);
  for (int k = 0; k < 3; k++) {
    point[k] = layer->centre[k] + arm[k];
    velocity[k] = layer->velocity[k] + swing[k];
  }
}

// ---- Guided layers ---------------------------------------------------------------------------------------------------

// The place of a guided particle in its layer, to be changed by whoever wants to leave it to itself; NULL: not guided.
static int32_t *guided_place(const SimEmitter *emitter, uint32_t id, const SimLayer **of) {
  for (int32_t k = 0; k < emitter->guided; k++) {
    const SimLayer *layer = &emitter->layer[k];
    uint32_t at = id - layer->first;
    if (id < layer->first || at >= (uint32_t)layer->count || layer->place[at] < 0) continue;
    if (of) *of = layer;
    return &layer->place[at];
  }
  return NULL;
}

// The stream has gone on: release what has gone as far as the support radius.
static void move_layers(SimEmitter *emitter, double way, double support) {
  for (int32_t k = 0; k < emitter->guided; k++) emitter->layer[k].ahead += way;
  while (emitter->guided > 0 && emitter->layer[emitter->guided - 1].ahead >= support) emitter->guided--;
}

static void guide(SimWorld *world, const SimEmitterDef *def, SimEmitter *emitter) {
  SimSorted *now = &world->particles.now;
  if (emitter->guided == 0) return;
  uint32_t oldest = emitter->layer[emitter->guided - 1].first;
  for (int32_t i = 0; i < world->particles.count; i++) {
    if (now->id[i] < oldest) continue;
    const SimLayer *layer;
    int32_t *place = guided_place(emitter, now->id[i], &layer);
    if (!place) continue;
    Opening opening = opening_at(world, def, layer->ahead);
    float point[3], velocity[3];
    place_in_world(&opening, &emitter->place[2 * *place], point, velocity);
    if (!sim_boundary_free(&world->boundary, point)) {
      *place = -1;
      continue;
    }
    for (int k = 0; k < 3; k++) now->position[k][i] = point[k], now->velocity[k][i] = velocity[k];
  }
}

// A new layer, the one that was released last makes room for it.
static void guide_new(SimEmitter *emitter, double ahead, uint32_t first, const int32_t *place, int32_t count) {
  if (emitter->guided == emitter->layer_room) emitter->guided--;
  SimLayer new = emitter->layer[emitter->guided];
  memmove(emitter->layer + 1, emitter->layer, sizeof new *(size_t)emitter->guided);
  new.first = first, new.count = count, new.ahead = ahead;
  memcpy(new.place, place, sizeof *place * (size_t)count);
  emitter->layer[0] = new;
  emitter->guided++;
}

// ---- Free places -----------------------------------------------------------------------------------------------------

static int32_t cell_index(const SimEmitter *emitter, int axis, float x, float spacing) {
  float t = (x + emitter->half[axis]) / spacing + 1;
  int32_t last = emitter->cells[axis] - 1;
  return t > 0 ? t < (float)last ? (int32_t)t : last : 0;
}

static bool add_nearby(SimEmitters *emitters, const SimEmitter *emitter, int32_t n, const float x[3], float spacing) {
  if (!sim_reserve_keep((void **)&emitters->nearby, (size_t)n + 1, sizeof(SimNearby))) return false;
  int32_t cell = cell_index(emitter, 0, x[1], spacing) * emitter->cells[1] + cell_index(emitter, 1, x[2], spacing);
  emitters->nearby[n] = (SimNearby){{x[0], x[1], x[2]}, emitters->head[cell]};
  emitters->head[cell] = n;
  return true;
}

// One pass over all particles: those in the box around the layer are put into a grid over its plane.
static bool find_nearby(SimWorld *world, const SimEmitter *emitter, const Opening *layer) {
  const SimSorted *now = &world->particles.now;
  float spacing = world->cubic.spacing, reach = TOO_NEAR * spacing, box[3];
  int32_t cells = emitter->cells[0] * emitter->cells[1], n = 0;
  for (int32_t c = 0; c < cells; c++) world->emitters.head[c] = -1;
  for (int k = 0; k < 3; k++)
    box[k] = fabsf(layer->axis[0][k]) * reach + fabsf(layer->axis[1][k]) * (emitter->half[0] + reach) +
             fabsf(layer->axis[2][k]) * (emitter->half[1] + reach);
  for (int32_t i = 0; i < world->particles.count; i++) {
    float d[3], x[3];
    for (int k = 0; k < 3; k++) d[k] = now->position[k][i] - layer->centre[k];
    if (!(fabsf(d[0]) < box[0] && fabsf(d[1]) < box[1] && fabsf(d[2]) < box[2])) continue;
    for (int a = 0; a < 3; a++) x[a] = d[0] * layer->axis[a][0] + d[1] * layer->axis[a][1] + d[2] * layer->axis[a][2];
    if (fabsf(x[0]) >= reach || fabsf(x[1]) >= emitter->half[0] + reach || fabsf(x[2]) >= emitter->half[1] + reach)
      continue;
    if (guided_place(emitter, now->id[i], NULL)) continue;
    if (!add_nearby(&world->emitters, emitter, n++, x, spacing)) return false;
  }
  return true;
}

static bool taken(const SimEmitters *emitters, const SimEmitter *emitter, const float place[2], float spacing) {
  float reach2 = TOO_NEAR * spacing * TOO_NEAR * spacing;
  int32_t a = cell_index(emitter, 0, place[0], spacing), b = cell_index(emitter, 1, place[1], spacing);
  for (int32_t y = a > 0 ? a - 1 : 0; y <= a + 1 && y < emitter->cells[0]; y++)
    for (int32_t z = b > 0 ? b - 1 : 0; z <= b + 1 && z < emitter->cells[1]; z++)
      for (int32_t n = emitters->head[y * emitter->cells[1] + z]; n >= 0; n = emitters->nearby[n].next) {
        const SimNearby *near = &emitters->nearby[n];
        float dy = near->x[1] - place[0], dz = near->x[2] - place[1];
        if (near->x[0] * near->x[0] + dy * dy + dz * dz < reach2) return true;
      }
  return false;
}

// ---- Emission --------------------------------------------------------------------------------------------------------

static bool emit_layer(SimWorld *world, const SimEmitterDef *def, SimEmitter *emitter, double ahead, SimError *error) {
  Opening layer = opening_at(world, def, ahead);
  float point[3], velocity[3];
  int32_t wanted = 0, *open = world->emitters.open;
  if (!find_nearby(world, emitter, &layer)) return sim_fail(error, "out of memory");
  for (int32_t p = 0; p < emitter->place_count; p++) {
    const float *place = &emitter->place[2 * p];
    place_in_world(&layer, place, point, velocity);
    if (sim_boundary_free(&world->boundary, point) && !taken(&world->emitters, emitter, place, world->cubic.spacing))
      open[wanted++] = p;
  }
  int32_t room = sim_world_make_way(world, wanted, error);
  if (room < 0) return false;
  uint32_t first = world->next_id;
  for (int32_t k = 0; k < room; k++) {
    place_in_world(&layer, &emitter->place[2 * open[k]], point, velocity);
    sim_world_add(world, point, velocity, def->colour);
  }
  world->counts.emitted += room;
  if (room > 0) guide_new(emitter, ahead, first, open, room);
  return true;
}

// Follow one emitter up to the present time.
static bool follow(SimWorld *world, const SimEmitterDef *def, SimEmitter *emitter, SimError *error) {
  double from = fmax(emitter->clock, def->start), to = world->time;
  emitter->clock = world->time;
  bool running = emitter->on && to < def->stop;
  if (!running) emitter->guided = 0, to = fmin(to, def->stop);
  if (!emitter->on || !(to > from)) return true;
  double way = (double)def->speed * (to - from), after = (double)def->speed * (world->time - to);
  move_layers(emitter, way, (double)world->cubic.h);
  guide(world, def, emitter);
  emitter->way += way;
  // A millionth is forgiven: substeps are rounded to single precision.
  while (emitter->way >= (double)emitter->pitch * (1 - 1e-6)) {
    emitter->way -= (double)emitter->pitch;
    if (!emit_layer(world, def, emitter, fmax(emitter->way + after, 0), error)) return false;
  }
  return true;
}

bool sim_emit(SimWorld *world, SimError *error) {
  for (int32_t e = 0; e < world->emitters.count; e++)
    if (!follow(world, &world->emitter_defs[e], &world->emitters.emitter[e], error)) return false;
  return true;
}

float sim_emit_speed(const SimWorld *world, double soon) {
  float fastest = 0;
  for (int32_t e = 0; e < world->emitters.count; e++) {
    const SimEmitterDef *def = &world->emitter_defs[e];
    if (!world->emitters.emitter[e].on || world->time + soon < def->start || world->time >= def->stop) continue;
    Opening layer = opening_at(world, def, 0);
    float speed2 = 0;
    for (int k = 0; k < 3; k++) speed2 += layer.velocity[k] * layer.velocity[k];
    fastest = fmaxf(fastest, sqrtf(speed2));
  }
  return fastest;
}

bool sim_world_set_emitter(SimWorld *world, int32_t index, bool on) {
  if (index < 0 || index >= world->emitters.count) return false;
  SimEmitter *emitter = &world->emitters.emitter[index];
  if (on && !emitter->on) emitter->clock = world->time, emitter->way = 0;
  emitter->on = on;
  return true;
}
