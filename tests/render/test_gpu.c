// The GPU layer: shader errors that name file and line, includes, programs made once, no object left behind.
#include "tests/render/harness.h"

#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>

#include "render/picture.h"

static const GpuSource sources[] = {
    {"good.glsl", "#ifdef VERTEX_STAGE\nvoid main() { gl_Position = vec4(0.0); }\n#else\n"
                  "layout(location = 0) out vec4 c;\n#ifndef RED\n#define RED 0.0\n#endif\n"
                  "void main() { c = vec4(RED, 0.0, 0.0, 1.0); }\n#endif\n"},
    {"broken.glsl",
     "// one\n// two\n#ifdef FRAGMENT_STAGE\nout vec4 c;\n"
     "void main() { c = vec4(undefined_name); }\n#else\nvoid main() { gl_Position = vec4(0.0); }\n#endif\n"},
    {"inner.glsl", "// a helper\nfloat twice(float x) {\n  return 2.0 * y_is_not_here;\n}\n"},
    {"outer.glsl", "// first\n#include \"inner.glsl\"\nvoid main() { gl_Position = vec4(twice(1.0)); }\n"},
    {"after.glsl", "// first\n#include \"fine.glsl\"\n// third\nvoid main() { gl_Position = vec4(oops); }\n"},
    {"fine.glsl", "const float A = 1.0;\nconst float B = 2.0;\nconst float C = 3.0;\n"},
    {"lost.glsl", "// first\n\n#include \"nowhere.glsl\"\n"},
    {"loop.glsl", "#include \"loop.glsl\"\n#include \"good.glsl\"\n"},
    {0},
};

static void expect_failure(const char *file, const char *start, const char *mention) {
  GpuProgram program = {0};
  RenderError error = {0};
  const GpuProgramDesc desc = {.label = "test", .file = file, .sources = sources};
  assert_false(gpu_program_prepare(&program, &desc, &error));
  assert_int_equal(program.id, 0);
  if (strncmp(error.message, start, strlen(start)) != 0 || strstr(error.message, mention) == NULL) {
    fail_msg("\"%s\" does not begin with \"%s\" or lacks \"%s\"", error.message, start, mention);
  }
  assert_null(strchr(error.message, '\n'));
}

static void test_shader_errors_name_file_and_line(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 8, 8);
  expect_failure("broken.glsl", "broken.glsl:5: ", "undefined_name");
  expect_failure("outer.glsl", "inner.glsl:3: ", "y_is_not_here");
  expect_failure("after.glsl", "after.glsl:4: ", "oops");
  expect_failure("lost.glsl", "lost.glsl:3: ", "nowhere.glsl");
  expect_failure("none.glsl", "there is no shader file", "none.glsl");
  harness_close(&harness);
}

static void test_programs_are_made_once(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 8, 8);
  GpuProgram program = {0};
  RenderError error = {0};
  GpuProgramDesc desc = {.label = "test", .file = "good.glsl", .sources = sources};
  assert_true(gpu_program_prepare(&program, &desc, &error));
  const GpuProgram first = program;
  assert_true(gpu_program_prepare(&program, &desc, &error));
  assert_int_equal(program.id, first.id);
  desc.defines = "#define RED 1.0\n";
  assert_true(gpu_program_prepare(&program, &desc, &error));
  assert_true(program.identity != first.identity);
  // A program that fails leaves the working one in place.
  const GpuProgram working = program;
  desc.defines = "#define RED nonsense\n";
  assert_false(gpu_program_prepare(&program, &desc, &error));
  assert_int_equal(program.id, working.id);
  // A file that includes itself is taken once.
  desc = (GpuProgramDesc){.label = "loop", .file = "loop.glsl", .sources = sources};
  assert_true(gpu_program_prepare(&program, &desc, &error));
  gpu_program_destroy(&program);
  harness_close(&harness);
}

// How many objects of all kinds there are, among the first names that GL hands out.
static int count_objects(void) {
  int count = 0;
  for (GLuint name = 1; name < 4096; ++name) {
    count += glIsTexture(name) + glIsBuffer(name) + glIsFramebuffer(name) + glIsVertexArray(name) + glIsQuery(name) +
             glIsProgram(name) + glIsShader(name);
  }
  return count;
}

static void test_no_object_is_left_behind(void **state) {
  (void)state;
  AppError app_error = {0};
  Context *context = context_create_headless(CONTEXT_AUTO, &app_error);
  assert_non_null(context);
  int before = 0;
  TestFrame *t = test_frame_create(1, 0.0175f);
  test_frame_add(t, 1, 1, 0.5f);
  t->frame.obstacle_count = SIM_SHAPE_COUNT;
  t->frame.container.shape = SIM_CONTAINER_GLASS;
  t->mesh = test_mesh_torus(0.2f, 0.1f, 8, 6);
  for (int shape = 0; shape < SIM_SHAPE_COUNT; ++shape) {
    t->obstacles[shape] =
        (SimObstacle){(SimShape)shape, {0.3f, 0.4f, 0.3f}, {1, 0.5f, 0.5f}, {0, 0, 0, 1}, {1, 0, 0}, 3, t->mesh};
  }
  const RenderView view = harness_view(1.5f, 1, 4, 1.5f, 0.5f, 0.5f, 38);
  const RenderSettings settings = render_default_settings();
  for (int i = 0; i < 51; ++i) {
    RenderError error = {0};
    Render *render = render_create(16, 16, &error);
    assert_non_null(render);
    // Drawing makes the programs, which is slow; some rounds do it, and some change the size in between.
    if (i % 10 == 0) {
      assert_true(render_draw(render, &t->frame, &view, &settings, &error));
      if (i > 0) assert_true(count_objects() > before);
      assert_true(render_resize(render, 24, 20, &error));
      assert_true(render_draw(render, &t->frame, &view, &settings, &error));
    }
    assert_int_equal(render_gl_error_count(render), 0);
    render_destroy(render);
    // A driver may hold on to the program that it used last, so the first round says what "nothing" is.
    if (i == 0) before = count_objects();
    assert_true(before <= 4);
    assert_int_equal(count_objects(), before);
  }
  test_frame_destroy(t);
  context_destroy(context);
}

// A mesh goes to the GPU once and stays as long as it is shown; what counts is its content, not its address.
static void test_meshes_are_uploaded_once(void **state) {
  (void)state;
  AppError app_error = {0};
  Context *context = context_create_headless(CONTEXT_AUTO, &app_error);
  assert_non_null(context);
  RenderMeshes meshes = {0};
  RenderError error = {0};
  SimMesh *ring = test_mesh_torus(0.2f, 0.1f, 8, 6), *same = test_mesh_torus(0.2f, 0.1f, 8, 6);
  SimMesh *other = test_mesh_torus(0.3f, 0.1f, 8, 6);
  int32_t a = -1, b = -1, c = -1;
  assert_true(render_meshes_take(&meshes, ring, &a, &error) && render_meshes_take(&meshes, same, &b, &error) &&
              render_meshes_take(&meshes, other, &c, &error));
  assert_int_equal(a, b);
  assert_int_not_equal(a, c);
  assert_int_equal(meshes.count, 2);
  assert_int_equal(meshes.meshes[a].corner_count, 3 * 2 * 8 * 6);
  assert_float_equal(meshes.meshes[a].reach, 0.3f, 1e-6f);
  const unsigned buffer = meshes.meshes[a].corners.id;
  // The next picture shows only the first, the one after that none.
  render_meshes_forget(&meshes);
  assert_true(render_meshes_take(&meshes, same, &b, &error));
  assert_int_equal(meshes.meshes[b].corners.id, buffer);
  render_meshes_forget(&meshes);
  assert_int_equal(meshes.count, 1);
  assert_int_equal(meshes.meshes[0].corners.id, buffer);
  render_meshes_forget(&meshes);
  assert_int_equal(meshes.count, 0);
  assert_int_equal(glIsBuffer(buffer), GL_FALSE);
  render_meshes_destroy(&meshes);
  test_mesh_destroy(ring);
  test_mesh_destroy(same);
  test_mesh_destroy(other);
  context_destroy(context);
}

static void test_sizes_out_of_range_are_refused(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 8, 8);
  const int32_t sizes[][2] = {{0, 8}, {8, 0}, {-1, 8}, {16385, 8}, {8, 16385}};
  for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
    RenderError error = {0};
    assert_null(render_create(sizes[i][0], sizes[i][1], &error));
    assert_non_null(strstr(error.message, "out of range"));
    assert_false(render_resize(harness.render, sizes[i][0], sizes[i][1], &error));
  }
  harness_close(&harness);
}

static void test_driver_errors_are_counted(void **state) {
  (void)state;
#ifdef RENDER_ABORT_ON_GL_ERROR
  skip(); // there they end the program
#endif
  AppError app_error = {0};
  Context *context = context_create_headless(CONTEXT_AUTO, &app_error);
  assert_non_null(context);
  Gpu gpu;
  RenderError error;
  assert_true(gpu_create(&gpu, &error));
  assert_int_equal(gpu.error_count, 0);
  glEnable(0x12345);
  gpu_collect_errors(&gpu);
  assert_int_equal(gpu.error_count, 1);
  assert_true(gpu.last_error[0] != '\0');
  gpu_destroy(&gpu);
  context_destroy(context);
}

static void test_passes_are_timed(void **state) {
  (void)state;
  Harness harness = harness_open(CONTEXT_AUTO, 64, 64);
  TestFrame *t = test_frame_create(1, 0.05f);
  test_frame_add(t, 1.5f, 0.5f, 0.5f);
  const RenderView view = harness_view(1.5f, 1, 4, 1.5f, 0.5f, 0.5f, 38);
  const RenderSettings settings = render_default_settings();
  free(harness_draw(&harness, &t->frame, &view, &settings));
  RenderPassTime times[32];
  const int32_t count = render_pass_times(harness.render, times, 32);
  const char *const expected[] = {"upload", "sun map", "background", "splat", "thickness", "shade", "compose"};
  assert_int_equal(count, sizeof expected / sizeof expected[0]);
  double gpu = 0;
  for (int32_t i = 0; i < count; ++i) {
    assert_string_equal(times[i].name, expected[i]);
    assert_true(times[i].cpu_milliseconds >= 0 && times[i].gpu_milliseconds >= 0);
    gpu += times[i].gpu_milliseconds;
  }
  assert_true(gpu > 0);
  assert_int_equal(render_pass_times(harness.render, times, 2), count);
  test_frame_destroy(t);
  harness_close(&harness);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shader_errors_name_file_and_line),
      cmocka_unit_test(test_programs_are_made_once),
      cmocka_unit_test(test_no_object_is_left_behind),
      cmocka_unit_test(test_sizes_out_of_range_are_refused),
      cmocka_unit_test(test_meshes_are_uploaded_once),
      cmocka_unit_test(test_driver_errors_are_counted),
      cmocka_unit_test(test_passes_are_timed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
