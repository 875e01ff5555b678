// Water that is a sum of waves: heights and normals against the formula, dispersion, and what is refused.
#include "sim_test.h"

#include "sim/ripple.h"
#include "sim/world.h"

#define PI 3.14159265358979323846

static SimBlockDef block;

// A pool of 2.4 × 1 × 1.6 m, its corner off the origin, 0.6 m deep.
static SimWorldDef ripple_def(const SimWaveDef *waves, int32_t count) {
  SimWorldDef def = test_def((const float[3]){2.4f, 1.2f, 1.8f}, &block, (const float[3]){1, 1, 1});
  def.container.min[1] = 0.2f, def.container.min[2] = 0.2f;
  def.block_count = 0;
  def.ripple = true;
  def.ripple_level = 0.8f;
  def.wave_count = count;
  def.waves = waves;
  return def;
}

static const SimWaveDef mixed[3] = {
    {0.02f, 1.3f, {1, 0.5f}, 0.4f, false}, {0.01f, 0.5f, {-3, 1}, 1.7f, false}, {0.015f, 0.8f, {0, -2}, 0.9f, true}};

// The formula, as the paper's reader would write it.
static double height_by_formula(const SimWorldDef *def, double x, double z, double t, double slope[2]) {
  double height = (double)def->ripple_level, depth = height - (double)def->container.min[1];
  slope[0] = slope[1] = 0;
  for (int32_t w = 0; w < def->wave_count; w++) {
    const SimWaveDef *wave = &def->waves[w];
    double length = hypot((double)wave->direction[0], (double)wave->direction[1]),
           k = 2 * PI / (double)wave->wavelength;
    double kx = k * (double)wave->direction[0] / length, kz = k * (double)wave->direction[1] / length;
    double omega = sqrt(9.81f * k * tanh(k * depth)), a = (double)wave->amplitude;
    double phase = kx * x + kz * z + (double)wave->phase - (wave->standing ? 0 : omega * t);
    if (wave->standing) a *= cos(omega * t);
    height += a * cos(phase);
    slope[0] -= a * kx * sin(phase), slope[1] -= a * kz * sin(phase);
  }
  return height;
}

static void check_frame(const SimWorldDef *def, const SimFrame *frame) {
  const SimHeightField *f = &frame->height_field;
  assert_true(frame->count == 0 && f->size[0] > 1 && f->size[1] > 1);
  for (int k = 0; k < f->size[1]; k++)
    for (int i = 0; i < f->size[0]; i++) {
      int node = k * f->size[0] + i;
      double x = (double)(f->origin[0] + f->spacing * (float)i), z = (double)(f->origin[1] + f->spacing * (float)k),
             slope[2];
      double height = height_by_formula(def, x, z, frame->time, slope),
             length = sqrt(1 + slope[0] * slope[0] + slope[1] * slope[1]);
      const double normal[3] = {-slope[0] / length, 1 / length, -slope[1] / length};
      if (fabs((double)f->height[node] - height) > 1e-6)
        fail_msg("%g at (%g, %g), not %g", (double)f->height[node], x, z, height);
      for (int a = 0; a < 3; a++) assert_true(fabs((double)f->normal[3 * node + a] - normal[a]) < 3e-6);
    }
}

static void heights_match_the_formula(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int32_t count = 0; count <= 3; count++) {
    SimWorldDef def = ripple_def(mixed, count);
    SimWorld *world = test_create(&def);
    for (int n = 0; n < 3; n++) { // at the start, soon, and an hour later
      check_frame(&def, test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer));
      test_advance(world, 7);
      if (n == 1) world->time += 3600;
    }
    sim_world_reset(world);
    const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
    assert_true(frame->time == 0);
    check_frame(&def, frame);
    assert_null(test_frame(world, SIM_NEED_NOTHING, buffer)->height_field.height);
    sim_world_destroy(world);
  }
  sim_frame_buffer_destroy(buffer);
  assert_int_equal(sim_bytes_in_use(), 0);
}

static void waves_are_as_fast_as_depth_and_gravity_make_them(void **state) {
  (void)state;
  // Deep: the speed is g/ω; shallow: √(g d), whatever the wavelength; in between, by hand (k = 2π, d = 0.25: tanh = 0.91715).
  assert_true(fabs(sim_wave_frequency(1, 9.81, 50) - sqrt(9.81 * 2 * PI)) < 1e-9);
  assert_true(fabs(sim_wave_frequency(1000, 9.81, 0.5) * 1000 / (2 * PI) / sqrt(9.81 * 0.5) - 1) < 1e-5);
  assert_true(fabs(sim_wave_frequency(1, 9.81, 0.25) - sqrt(9.81 * 2 * PI * 0.917152)) < 1e-5);
}

// A crest goes along its direction: after a period it is where the next one was. A standing wave is level after a quarter of it.
static void crests_travel_and_standing_waves_stand(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  for (int standing = 0; standing < 2; standing++) {
    const SimWaveDef wave = {0.05f, 0.8f, {1, 0}, 0, standing};
    SimWorldDef def = ripple_def(&wave, 1);
    SimWorld *world = test_create(&def);
    SimError error;
    double period = 2 * PI / sim_wave_frequency((double)wave.wavelength, (double)9.81f, (double)(0.8f - 0.2f));
    assert_true(sim_world_advance(world, period / 4, &error));
    const SimHeightField *f = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
    int crest = 0;
    for (int i = 1; i < 20; i++)
      if (f->height[i] > f->height[crest]) crest = i;
    for (int i = 0; standing && i < f->size[0] * f->size[1]; i++) assert_true(fabsf(f->height[i] - 0.8f) < 1e-6f);
    if (!standing)
      assert_true(fabsf(f->spacing * (float)crest - 0.2f) <= 0.5001f * f->spacing); // a quarter wavelength on
    sim_world_destroy(world);
  }
  sim_frame_buffer_destroy(buffer);
}

// About a twentieth of the shortest wave, never more nodes than can be handled, in a glass too.
static void nodes_suit_the_waves(void **state) {
  (void)state;
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const float wavelengths[4] = {1000, 0.8f, 0.1f, 0.05f}, longest[4] = {0.0751f, 0.0401f, 0.00501f, 0.00501f};
  for (int w = 0; w < 4; w++)
    for (int glass = 0; glass < 2; glass++) {
      const SimWaveDef wave = {0.01f, wavelengths[w], {1, 1}, 0, false};
      SimWorldDef def = ripple_def(&wave, 1);
      def.container.shape = glass ? SIM_CONTAINER_GLASS : SIM_CONTAINER_BOX;
      SimWorld *world = test_create(&def);
      const SimHeightField *f = &test_frame(world, SIM_NEED_HEIGHT_FIELD, buffer)->height_field;
      assert_true(f->spacing <= longest[w] && f->spacing > 0.7f * longest[w] && f->size[0] * f->size[1] <= 1 << 20);
      assert_true(glass ? f->height[0] == 0.2f && f->normal[1] == 1 : f->height[0] > 0.7f);
      sim_world_destroy(world);
    }
  sim_frame_buffer_destroy(buffer);
}

// Obstacles stand, move and are dragged; the same bytes for any number of threads.
static void obstacles_move_in_it(void **state) {
  (void)state;
  SimObstacleDef bodies[2] = {sim_default_obstacle_def(), sim_default_obstacle_def()};
  uint64_t hash[3];
  for (int k = 0; k < 2; k++) {
    bodies[k].body = (SimObstacle){SIM_BOX, {0.2f, 0.5f, 0.2f}, {0.5f + (float)k, 0.7f, 1}, {0, 0, 0, 1}};
    bodies[k].motion = k ? SIM_DRAGGABLE : SIM_SCRIPTED;
  }
  bodies[0].stroke[0] = 0.3f;
  for (int32_t n = 0; n < 3; n++) {
    SimWorldDef def = ripple_def(mixed, 3);
    def.obstacle_count = 2, def.obstacles = bodies;
    def.threads = 1 + 2 * n;
    SimWorld *world = test_create(&def);
    SimFrameBuffer *buffer = sim_frame_buffer_create();
    assert_true(sim_world_drag(world, 1, (const float[3]){1.6f, 0.9f, 1}, NULL));
    test_advance(world, 30);
    const SimFrame *frame = test_frame(world, SIM_NEED_ALL, buffer);
    assert_true(fabsf(frame->obstacles[0].position[0] - 0.8f) < 1e-5f);
    assert_true(fabsf(frame->obstacles[1].position[0] - 1.6f) < 0.02f &&
                fabsf(frame->obstacles[1].position[1] - 0.9f) < 0.02f);
    check_frame(&def, frame);
    hash[n] = test_hash_surface(frame, 1);
    assert_true(sim_world_measures(world).kinetic_energy == 0);
    sim_frame_buffer_destroy(buffer);
    sim_world_destroy(world);
  }
  assert_true(hash[0] == hash[1] && hash[0] == hash[2]);
}

static void refused(const SimWorldDef *def, const char *named) {
  SimError error = {""};
  SimWorld *world = sim_world_create(def, &error);
  if (world) fail_msg("accepted although %s is wrong", named);
  if (!strstr(error.message, named)) fail_msg("the message \"%s\" does not name %s", error.message, named);
}

static void bad_waves_are_refused(void **state) {
  (void)state;
  static const struct {
    SimWaveDef wave;
    const char *named;
  } cases[] = {{{-0.01f, 1, {1, 0}, 0, false}, "amplitude"},     {{NAN, 1, {1, 0}, 0, false}, "amplitude"},
               {{0.01f, 0.04f, {1, 0}, 0, false}, "wavelength"}, {{0.01f, INFINITY, {1, 0}, 0, false}, "wavelength"},
               {{0.01f, 1, {0, 0}, 0, false}, "direction"},      {{0.01f, 1, {NAN, 0}, 0, false}, "direction"},
               {{0.01f, 1, {1, 0}, INFINITY, false}, "phase"},   {{0.6f, 1, {1, 0}, 0, false}, "floor"}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    SimWorldDef def = ripple_def(&cases[k].wave, 1);
    refused(&def, cases[k].named);
  }
}

static void what_needs_particles_is_refused(void **state) {
  (void)state;
  SimObstacleDef raft = sim_default_obstacle_def();
  SimWorldDef def = ripple_def(mixed, 3);
  def.wave_count = SIM_MAX_WAVES + 1;
  refused(&def, "waves");
  def.wave_count = 1, def.waves = NULL;
  refused(&def, "no array");
  def = ripple_def(mixed, 3);
  def.ripple = false;
  refused(&def, "ripple");
  def = ripple_def(mixed, 3);
  def.ripple_level = NAN;
  refused(&def, "ripple_level");
  def.ripple_level = 1.19f;
  refused(&def, "ripple_level");
  def = ripple_def(mixed, 3);
  def.gravity[1] = 0;
  refused(&def, "gravity");
  def = ripple_def(mixed, 3);
  def.block_count = 1;
  refused(&def, "blocks");
  def = ripple_def(mixed, 3);
  raft.motion = SIM_FLOATING;
  def.obstacle_count = 1, def.obstacles = &raft;
  refused(&def, "floats");
  def = ripple_def(mixed, 3);
  SimWorld *world = test_create(&def);
  SimError error = {""};
  assert_int_equal(sim_world_pour(world, &(SimBlockDef){{0.1f, 0.9f, 0.3f}, {0.3f, 1, 0.5f}, {0}, {0}}, &error), -1);
  assert_non_null(strstr(error.message, "ripple"));
  sim_world_destroy(world);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(heights_match_the_formula),
      cmocka_unit_test(waves_are_as_fast_as_depth_and_gravity_make_them),
      cmocka_unit_test(crests_travel_and_standing_waves_stand),
      cmocka_unit_test(nodes_suit_the_waves),
      cmocka_unit_test(obstacles_move_in_it),
      cmocka_unit_test(bad_waves_are_refused),
      cmocka_unit_test(what_needs_particles_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
