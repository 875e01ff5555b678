// Height fields made by hand, and the renderer's maps of them below its public face.
#ifndef LIDO_TESTS_RENDER_FIELDS_H
#define LIDO_TESTS_RENDER_FIELDS_H

#include "render/caustics.h"
#include "tests/render/harness.h"

/// A context and what the passes of a picture need of it.
typedef struct FieldBench {
  Context *context;
  Gpu gpu;
  RenderPicture picture;
  SimFrame frame;
  RenderSettings settings;
  RenderHeightMap map;
  RenderCaustics caustics;
} FieldBench;
int field_bench_open(void **state); ///< for a group of tests, as its state
int field_bench_close(void **state);

/// Height (m) over a place (m); NaN: no water.
typedef double (*FieldHeight)(double x, double z, const void *context);
typedef struct TestField {
  SimHeightField field;
  float *heights;
} TestField;
TestField test_field_create(int32_t columns, int32_t rows, float spacing, float x, float z, FieldHeight height,
                            const void *context);
void test_field_destroy(TestField *field);

/// The map of surfaces drawn and read back: (map.size[1], map.size[0], 4), to be freed.
float *field_bench_surface(FieldBench *bench, const TestField *field, float smoothing);

/// The map of light under a field, smoothed by as little as can be, read back: (light.height, light.width, 4), to be freed.
/// The floor, the sun and the liquid are those of bench->settings, obstacles those of bench->frame, which has no container.
float *field_bench_light(FieldBench *bench, const TestField *field);
/// Light at a point, between texels; 0 outside of the map.
void field_light_at(const FieldBench *bench, const float *light, const double point[3], double rgb[3]);

#endif
