#include "tests/render/water.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

TestWater test_water_from_set(const SimParticleSet *set, const SimContainer *container) {
  TestWater water = {.buffer = sim_frame_buffer_create()};
  SimError error = {0};
  const SimFrame *frame =
      sim_frame_from_particles(set, SIM_NEED_CLASS | SIM_NEED_ANISOTROPY | SIM_NEED_SURFACE, 1, water.buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  water.frame = *frame;
  water.frame.has_container = container != NULL;
  if (container != NULL) water.frame.container = *container;
  return water;
}

TestWater test_water_create(const float *position, int32_t count, float particle_radius,
                            const SimContainer *container) {
  const SimParticleSet set = {.count = count, .position = position, .particle_radius = particle_radius};
  return test_water_from_set(&set, container);
}

// A column with some disorder, from a radius above the floor on.
static void add_column(TestFrame *t, float radius, float level, float x, float z) {
  const float wobble = 0.2f * radius;
  for (float y = radius; y < level; y += 2 * radius) {
    test_frame_add(t, x + wobble * sinf(91 * y + 37 * z), y + wobble * sinf(57 * x + 83 * z),
                   z + wobble * sinf(71 * x + 47 * y));
  }
}

TestWater test_water_pool(const SimContainer *container, float radius, float level) {
  TestFrame *t = test_frame_create(20000, radius);
  const float spacing = 2 * radius, middle = container->max[0] / 2;
  if (container->shape == SIM_CONTAINER_BOX) {
    for (float z = radius; z < container->max[2]; z += spacing)
      for (float x = radius; x < container->max[0]; x += spacing) add_column(t, radius, level, x, z);
  } else {
    for (float ring = middle - radius; ring > 0; ring -= spacing) {
      const int count = (int)(6.2831853f * ring / spacing);
      for (int i = 0; i < count; ++i) {
        const float a = 6.2831853f * (float)i / (float)count;
        add_column(t, radius, level, middle + ring * cosf(a), middle + ring * sinf(a));
      }
    }
  }
  TestWater water = test_water_create(t->position, t->frame.count, radius, container);
  test_frame_destroy(t);
  return water;
}

TestWater test_water_settled(const SimContainer *container, float radius, float level) {
  SimWorldDef def = sim_default_world_def();
  SimBlockDef block = {.max = {0, level, 0}};
  memcpy(block.min, container->min, sizeof block.min);
  for (int k = 0; k < 3; k += 2) block.max[k] = container->max[k];
  def.particle_radius = radius;
  def.container = *container;
  def.block_count = 1;
  def.blocks = &block;
  def.jitter = 0.3f;
  SimError error = {0};
  SimWorld *world = sim_world_create(&def, &error);
  if (world == NULL || !sim_world_advance(world, 2, &error)) fail_msg("%s", error.message);
  SimFrameBuffer *buffer = sim_frame_buffer_create();
  const SimFrame *frame = sim_world_frame(world, SIM_NEED_NOTHING, buffer, &error);
  if (frame == NULL) fail_msg("%s", error.message);
  TestWater water = test_water_create(frame->position, frame->count, radius, container);
  sim_frame_buffer_destroy(buffer);
  sim_world_destroy(world);
  return water;
}

void test_water_destroy(TestWater *water) {
  sim_frame_buffer_destroy(water->buffer);
  *water = (TestWater){0};
}

Pinhole water_pinhole(const RenderView *view, int32_t width, int32_t height) {
  return pinhole_make(view->eye, view->target, view->vertical_fov, width, height);
}

SplatMap water_map_draw(Harness *harness, SplatSide side, const SimFrame *frame, const RenderView *view,
                        const RenderSettings *settings) {
  static const char *const names[2][2] = {{"front_depth", "front_normal"}, {"back_depth", "back_normal"}};
  const Pinhole pinhole = water_pinhole(view, harness->width, harness->height);
  const size_t pixels = (size_t)harness->width * (size_t)harness->height;
  const SplatMap map = {.depth = harness_layer(harness, names[side][0], 1, frame, view, settings),
                        .normal = harness_layer(harness, names[side][1], 3, frame, view, settings)};
  for (size_t i = 0; i < pixels; ++i) {
    float *normal = map.normal + 3 * i;
    const double world[3] = {(double)normal[0], (double)normal[1], (double)normal[2]};
    double turned[3];
    pinhole_to_view(&pinhole, world, turned);
    for (int k = 0; k < 3; ++k) normal[k] = (float)turned[k];
  }
  return map;
}

WaterMaps water_maps_draw(Harness *harness, const SimFrame *frame, const RenderView *view,
                          const RenderSettings *settings) {
  return (WaterMaps){{water_map_draw(harness, SPLAT_FRONT, frame, view, settings),
                      water_map_draw(harness, SPLAT_BACK, frame, view, settings)}};
}

void water_maps_destroy(WaterMaps *maps) {
  for (int side = 0; side < 2; ++side) splat_map_destroy(&maps->side[side]);
}

// ---- Comparing -------------------------------------------------------------------------------------------------------

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double length_of_difference(const float a[3], const float b[3]) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += ((double)a[k] - (double)b[k]) * ((double)a[k] - (double)b[k]);
  return sqrt(sum);
}

WaterDifference water_maps_compare(const SplatMap *a, const SplatMap *b, size_t pixels, double radius) {
  double *depth = malloc(2 * pixels * sizeof *depth), *normal = depth + pixels;
  WaterDifference d = {0};
  for (size_t i = 0; i < pixels; ++i) {
    if (a->depth[i] > 0 && b->depth[i] > 0) {
      depth[d.both] = fabs((double)a->depth[i] - (double)b->depth[i]) / radius;
      normal[d.both++] = length_of_difference(a->normal + 3 * i, b->normal + 3 * i);
    } else {
      d.one += a->depth[i] > 0 || b->depth[i] > 0;
    }
  }
  assert_true(d.both > pixels / 100);
  qsort(depth, d.both, sizeof *depth, ascending);
  qsort(normal, d.both, sizeof *normal, ascending);
  const size_t most = (size_t)(0.999 * (double)(d.both - 1));
  d.depth = depth[most];
  d.normal = normal[most];
  d.largest_depth = depth[d.both - 1];
  d.largest_normal = normal[d.both - 1];
  free(depth);
  return d;
}

void water_difference_print(const char *what, SplatSide side, const WaterDifference *d) {
  print_message("%-24s %-5s %6zu pixels, %zu in one only: depth %.2g r (largest %.2g), normal %.2g (largest %.2g)\n",
                what, side == SPLAT_FRONT ? "front" : "back", d->both, d->one, d->depth, d->largest_depth, d->normal,
                d->largest_normal);
}

void water_expect_raw(const char *what, SplatSide side, const SplatMap *got, const SplatMap *want, size_t pixels,
                      double radius) {
  const WaterDifference d = water_maps_compare(got, want, pixels, radius);
  water_difference_print(what, side, &d);
  assert_true(d.depth < 1e-3);
  assert_true(d.normal < 1e-3);
  assert_true(d.one <= d.both / 1000);
}
