// Archimedes: bodies float as deep as their density says, or sink.
#include "sim_test.h"

static SimBlockDef block;

typedef struct Rest {
  double draught; ///< of a body of equal horizontal cross-sections, in heights
  double speed;   ///< m/s, largest of the body in the last second
  double height;  ///< m, mean of its centre
  double water;   ///< m³
} Rest;

// A body of `size` is put into a pool of 1.2 × 1.2 m, 0.5 m deep. Its draught in the mean of the last second follows from the
// volumes of water and body, since the pool is a box: with A_b the body's cross-section and d its draught,
// level = (V + A_b d)/A and d = level − (y − h/2).
static Rest float_body(SimShape shape, float size, float density, float y, const float rotation[4], int frames) {
  SimObstacleDef body = sim_default_obstacle_def();
  body.motion = SIM_FLOATING;
  body.density = density;
  body.body.shape = shape;
  for (int k = 0; k < 3; k++) body.body.size[k] = size;
  body.body.position[0] = body.body.position[2] = 0.6f;
  body.body.position[1] = y;
  memcpy(body.body.rotation, rotation, sizeof body.body.rotation);
  SimWorldDef def = test_def((const float[3]){1.2f, 1.5f, 1.2f}, &block, (const float[3]){1.2f, 0.5f, 1.2f});
  def.obstacles = &body;
  def.obstacle_count = 1;
  SimWorld *world = test_create(&def);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  double volume = sim_world_counts(world).particles * pow(0.05, 3), mean = 0, speed = 0;
  double mass = (double)density * pow((double)size, 3);
  for (int f = 0; f < frames; f++) {
    test_advance(world, 1);
    const SimFrame *frame = test_frame(world, 0, buffer);
    test_inside_container(frame);
    if (f < frames - 60) continue;
    mean += (double)frame->obstacles[0].position[1] / 60;
    speed = fmax(speed, fabs(sim_world_measures(world).body_momentum[1]) / mass);
  }
  double h = (double)size, base = h * h, area = 1.44, bottom = mean - h / 2;
  double level = (volume - base * bottom) / (area - base);
  print_message("density %g: centre %.4f, draught %.3f, speed %.3f m/s\n", (double)density, mean, (level - bottom) / h, speed);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return (Rest){(level - bottom) / h, speed, mean, volume};
}

static const float upright[4] = {0, 0, 0, 1};

static void half_density_floats_half_deep(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 500, 0.45f, upright, 240);
  if (fabs(rest.draught - 0.5) > 0.05) fail_msg("draught %g", rest.draught);
}

// A cube is the same from below and from above: however it is turned, half of it is below the level of its centre.
static void half_density_floats_tilted(void **state) {
  (void)state;
  const float tilted[4] = {0.25f, 0.1f, 0.3f, 0.9f};
  Rest rest = float_body(SIM_BOX, 0.4f, 500, 0.55f, tilted, 240);
  double level = (rest.water + 0.5 * 0.064) / 1.44;
  if (fabs(rest.height - level) > 0.04) fail_msg("centre at %g, level %g", rest.height, level);
}

static void light_body_is_stable(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 100, 0.75f, upright, 240);
  if (fabs(rest.draught - 0.1) > 0.03) fail_msg("draught %g", rest.draught);
  if (rest.speed > 0.1) fail_msg("it still moves at %g m/s", rest.speed);
}

static void heavy_body_sinks(void **state) {
  (void)state;
  Rest rest = float_body(SIM_BOX, 0.4f, 2000, 0.45f, upright, 240);
  if (rest.height > 0.2 + 0.03) fail_msg("its centre is %g m above the floor", rest.height);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(half_density_floats_half_deep),
                                     cmocka_unit_test(half_density_floats_tilted),
                                     cmocka_unit_test(light_body_is_stable), cmocka_unit_test(heavy_body_sinks)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
