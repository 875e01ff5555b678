#include "tests/render/frames.h"

#include <math.h>
#include <stdlib.h>

TestFrame *test_frame_create(int32_t capacity, float particle_radius) {
  TestFrame *t = calloc(1, sizeof *t);
  const size_t n = (size_t)capacity + 1;
  t->position = calloc(3 * n, sizeof(float));
  t->velocity = calloc(3 * n, sizeof(float));
  t->density = calloc(n, sizeof(float));
  t->id = calloc(n, sizeof(uint32_t));
  t->frame = (SimFrame){
      .particle_radius = particle_radius,
      .position = t->position,
      .velocity = t->velocity,
      .density = t->density,
      .id = t->id,
      .bounds_max = {3, 1.6f, 1},
      .container = {{0, 0, 0}, {3, 1.6f, 1}},
      .has_container = true,
      .obstacles = t->obstacles,
  };
  return t;
}

void test_frame_destroy(TestFrame *t) {
  if (t == NULL) return;
  free(t->position);
  free(t->velocity);
  free(t->density);
  free(t->id);
  free(t);
}

void test_frame_add(TestFrame *t, float x, float y, float z) {
  const size_t i = (size_t)t->frame.count++;
  t->position[3 * i] = x;
  t->position[3 * i + 1] = y;
  t->position[3 * i + 2] = z;
  t->density[i] = 1000;
  t->id[i] = (uint32_t)i;
}

static float wave_height(float x, float z) {
  return 0.24f + 0.05f * sinf(4.2f * x + 0.6f) * cosf(2.1f * z) + 0.02f * sinf(9 * x + 5 * z) +
         0.55f * expf(-4 * x * x);
}

TestFrame *test_frame_pool(void) {
  const float spacing = 0.035f;
  TestFrame *t = test_frame_create(40000, spacing / 2);
  for (int k = 0; k < 28; ++k) {
    for (int i = 0; i < 85; ++i) {
      const float x = spacing * ((float)i + 0.5f), z = spacing * ((float)k + 0.5f);
      for (float y = spacing / 2; y < wave_height(x, z); y += spacing) {
        // A little disorder, the same every time.
        const float wobble = 0.2f * spacing;
        test_frame_add(t, x + wobble * sinf(91 * y + 37 * z), y + wobble * sinf(57 * x + 83 * z),
                       z + wobble * sinf(71 * x + 47 * y));
      }
    }
  }
  // A fan of drops, fast and far apart.
  for (int i = 0; i < 160; ++i) {
    const float a = 0.04f * (float)i, r = 0.25f + 0.004f * (float)i;
    const int32_t n = t->frame.count;
    test_frame_add(t, 1.9f + r * cosf(a * 7), 0.45f + 0.5f * fabsf(sinf(3.7f * a)), 0.5f + 0.45f * sinf(a * 5));
    t->density[n] = 350;
    t->velocity[3 * n] = 3.5f;
  }
  return t;
}
