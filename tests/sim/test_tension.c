// Surface tension: its sweeps against sums over all pairs, a cube that becomes a ball, a ball that rings with Lamb's tone.
#include "sim_test.h"

#include "sim/tension.h"
#include "sim/world.h"

#define PI 3.14159265358979323846

static SimBlockDef block;
static SimDropDef drop;

// A weightless cube or ball of `across` spacings of 5 mm, of water.
static SimWorldDef weightless_def(SimSolver solver, int across, bool ball) {
  const float d = 0.005f, size = 4 * (float)across * d;
  SimWorldDef def = test_def((const float[3]){size, size, size}, &block, (const float[3]){0, 0, 0});
  for (int k = 0; k < 3; k++) {
    drop.centre[k] = size / 2;
    block.min[k] = size / 2 - (float)across * d / 2;
    block.max[k] = size / 2 + (float)across * d / 2;
  }
  drop.radius = (float)across * d / 2;
  if (ball) {
    def.block_count = 0;
    def.drops = &drop;
    def.drop_count = 1;
  }
  def.solver = solver;
  def.particle_radius = d / 2;
  memset(def.gravity, 0, sizeof def.gravity);
  def.surface_tension = 0.072f;
  return def;
}

static double slow_cohesion(double r, double h) {
  double a = (h - r) * (h - r) * (h - r) * r * r * r, scale = 32 / (PI * pow(h, 9));
  return r >= h ? 0 : scale * (2 * r > h ? a : 2 * a - pow(h, 6) / 64);
}

static void sweeps_match_all_pairs(void **state) {
  (void)state;
  SimWorldDef def = weightless_def(SIM_SOLVER_PBF, 8, false);
  for (int k = 0; k < 3; k++)
    block.min[k] -= def.container.max[0] / 2 - 0.02f, block.max[k] -= def.container.max[0] / 2 - 0.02f;
  def.jitter = 0.3f; // in a corner: walls count in the normals
  SimWorld *world = test_create(&def);
  SimParticles *p = &world->particles;
  SimStep step = sim_step_make(world, 0.002f);
  int32_t n = p->count;
  double h = (double)world->cubic.h, volume = (double)world->cubic.volume, mass = 1000 * volume;
  double gamma = 0.125 * 0.072 * 7040 / (21 * 1e6 * h * h), bend = 0.27 * 0.072 / (1000 * 3 * h * h / 80), most = 0;
  double(*normal)[4] = calloc((size_t)n, sizeof *normal);
  for (int32_t i = 0; i < n; i++)
    for (int k = 0; k < 3; k++) p->now.next_velocity[k][i] = 0;
  for (int32_t k = 0; k < 4 * n; k++) p->second[k] = p->first[k];
  sim_particles_pad(p, p->second);
  sim_step_tension(&step, &def, p->second);
  for (int pass = 0; pass < 2; pass++)
    for (int32_t i = 0; i < n; i++) {
      double sum[3] = {0}, density = volume * sim_kernel_cubic(0, h);
      for (int32_t j = 0; j < n; j++) {
        double e[3], r = 0;
        for (int k = 0; k < 3; k++)
          e[k] = (double)p->second[4 * i + k] - (double)p->second[4 * j + k], r += e[k] * e[k];
        r = sqrt(r);
        if (i == j || r >= h) continue;
        density += volume * sim_kernel_cubic(r, h);
        for (int k = 0; k < 3; k++)
          sum[k] += pass ? -2 / (normal[i][3] + normal[j][3]) *
                               (gamma * mass * slow_cohesion(r, h) * e[k] / r +
                                bend * volume * sim_kernel_cubic(r, h) * (normal[i][k] - normal[j][k]))
                         : volume * sim_kernel_cubic_derivative(r, h) * e[k] / r;
      }
      if (!pass) {
        bool near = p->near[i / SIM_CHUNK];
        normal[i][3] = density + (near ? (double)p->solid[4 * i + 3] : 0);
        for (int k = 0; k < 3; k++) {
          normal[i][k] = h * (sum[k] + (near ? (double)p->solid[4 * i + k] : 0)) / normal[i][3];
          assert_true(fabs(normal[i][k] - (double)p->work[4 * i + k]) < 1e-4);
        }
        continue;
      }
      for (int k = 0; k < 3; k++) {
        double v = (double)p->now.next_velocity[k][i],
               moved = (double)p->first[4 * i + k] - (double)p->second[4 * i + k];
        most = fmax(most, fabs(v));
        if (fabs(v - 0.002 * sum[k]) > 1e-5) fail_msg("tension on %d: %g, %g", i, 0.002 * sum[k], v);
        assert_true(fabs(moved - 0.002 * v) < 1e-7);
      }
    }
  assert_true(most > 1e-3);
  free(normal);
  sim_world_destroy(world);
}

// ---- A cube becomes a ball -------------------------------------------------------------------------------------------

typedef struct Shape {
  double centre[3], second[3]; ///< mean of x and of (x − centre)² along the axes
  double narrowest, widest;    ///< smallest and largest reach from the centre, over 400 directions
} Shape;

static Shape shape_of(const SimWorld *world) {
  const SimParticles *p = &world->particles;
  Shape shape = {{0}, {0}, INFINITY, 0};
  for (int k = 0; k < 3; k++) {
    for (int32_t i = 0; i < p->count; i++) shape.centre[k] += (double)p->now.position[k][i] / p->count;
    for (int32_t i = 0; i < p->count; i++)
      shape.second[k] += pow((double)p->now.position[k][i] - shape.centre[k], 2) / p->count;
  }
  for (int a = 0; a < 400; a++) {
    double z = 1 - 2 * (a + 0.5) / 400, turn = a * 2.399963, s = sqrt(1 - z * z), reach = 0;
    const double u[3] = {s * cos(turn), s * sin(turn), z};
    for (int32_t i = 0; i < p->count; i++) {
      double along = 0;
      for (int k = 0; k < 3; k++) along += u[k] * ((double)p->now.position[k][i] - shape.centre[k]);
      reach = fmax(reach, along);
    }
    shape.narrowest = fmin(shape.narrowest, reach);
    shape.widest = fmax(shape.widest, reach);
  }
  return shape;
}

static void a_cube_becomes_a_ball(void **state) {
  (void)state;
  for (int solver = 0; solver < 2; solver++) {
    SimWorldDef def = weightless_def((SimSolver)solver, 16, false);
    SimWorld *world = test_create(&def);
    double radius = 0.08 * cbrt(3 / (4 * PI)), period = 2 * PI * sqrt(1000 * radius * radius * radius / (8 * 0.072));
    Shape start = shape_of(world);
    assert_true(start.widest / start.narrowest > 1.5);
    SimError error = {""};
    for (int f = 0; f < 50; f++)
      if (!sim_world_advance(world, 1.5 * period / 50, &error)) fail_msg("%s", error.message);
    Shape shape = shape_of(world);
    SimMeasures measures = sim_world_measures(world);
    double big = 0, small = INFINITY, drift = 0, mass = 1000 * 0.08 * 0.08 * 0.08, momentum = 0, gyration = 0;
    for (int k = 0; k < 3; k++) {
      big = fmax(big, shape.second[k]), small = fmin(small, shape.second[k]), gyration += shape.second[k];
      drift += pow(shape.centre[k] - start.centre[k], 2), momentum += pow(measures.momentum[k], 2);
    }
    print_message("solver %d: axes 1:%.4f, reach 1:%.4f, radius %.4f of the ball's, drift %.1e R, density error %.4f\n",
                  solver, sqrt(big / small), shape.widest / shape.narrowest, sqrt(gyration * 5 / 3) / radius,
                  sqrt(drift) / radius, measures.mean_density_error);
    assert_true(sqrt(big / small) < 1.05 && shape.widest / shape.narrowest < 1.05);
    assert_true(fabs(sqrt(gyration * 5 / 3) / radius - 1) < 0.02);
    assert_true(sqrt(drift) < 1e-4 * radius);
    assert_true(sqrt(momentum) < 1e-5 * mass * radius / period);
    assert_true(measures.mean_density_error <= 0.01);
    sim_world_destroy(world);
  }
}

// ---- Lamb ------------------------------------------------------------------------------------------------------------

static double stretch(const SimWorld *world) {
  Shape shape = shape_of(world);
  return 2 * shape.second[2] - shape.second[0] - shape.second[1];
}

// Mode n = 2 of a drop: ω² = 8σ/(ρR³). Started as its flow field, u = A (−x, −y, 2z); half a period passes between zeros.
static void a_drop_rings_with_lambs_tone(void **state) {
  (void)state;
  for (int solver = 0; solver < 2; solver++) {
    SimWorldDef def = weightless_def((SimSolver)solver, 16, true);
    SimWorld *world = test_create(&def);
    double d = 0.005, radius = cbrt(3 * world->particles.count * d * d * d / (4 * PI));
    double omega = sqrt(8 * 0.072 / (1000 * radius * radius * radius)), step = 2 * PI / omega / 40;
    SimError error = {""};
    for (int f = 0; f < 40; f++) // the lattice comes to rest first
      if (!sim_world_advance(world, step, &error)) fail_msg("%s", error.message);
    for (int32_t i = 0; i < world->particles.count; i++)
      for (int k = 0; k < 3; k++)
        world->particles.now.velocity[k][i] =
            (float)(0.12 * omega * (k == 2 ? 2 : -1) *
                    ((double)world->particles.now.position[k][i] - (double)drop.centre[k]));
    double before = 0, crossing[8] = {0};
    int crossings = 0;
    for (int f = 1; f <= 100 && crossings < 4; f++) {
      if (!sim_world_advance(world, step, &error)) fail_msg("%s", error.message);
      double now = stretch(world);
      if (f > 1 && now * before < 0) crossing[crossings++] = f - now / (now - before);
      before = now;
    }
    assert_true(crossings >= 3);
    double half = (crossing[crossings - 1] - crossing[0]) / (crossings - 1), ratio = 20 / half;
    print_message("solver %d, radius of %.1f spacings: %.3f of Lamb's frequency\n", solver, radius / d, ratio);
    assert_true(fabs(ratio - 1) < 0.15);
    sim_world_destroy(world);
  }
}

// Two particles attract each other equally; one is left alone; two in one place do not divide by zero.
static void few_particles(void **state) {
  (void)state;
  for (int count = 1; count <= 3; count++) {
    SimWorldDef def = weightless_def(SIM_SOLVER_PBF, 4, false);
    SimWorld *world = test_create(&def);
    SimParticles *p = &world->particles;
    p->count = count;
    for (int32_t i = 0; i < count; i++)
      for (int k = 0; k < 3; k++) {
        p->now.position[k][i] = 0.04f + (k == 0 && i == 1 ? 0.006f : 0);
        p->now.velocity[k][i] = 0;
      }
    world->settled = false;
    SimError error = {""};
    if (!sim_world_advance(world, 0.01, &error)) fail_msg("%s", error.message);
    double momentum = 0;
    for (int32_t i = 0; i < count; i++) momentum += (double)p->now.velocity[0][i];
    assert_true(fabs(momentum) < 1e-7);
    if (count == 2) assert_true(fabsf(p->now.position[0][0] - p->now.position[0][1]) < 0.006f);
    sim_world_destroy(world);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sweeps_match_all_pairs),
      cmocka_unit_test(a_cube_becomes_a_ball),
      cmocka_unit_test(a_drop_rings_with_lambs_tone),
      cmocka_unit_test(few_particles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
