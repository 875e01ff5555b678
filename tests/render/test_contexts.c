// The same frame under different contexts is the same picture.
#include "tests/render/harness.h"

#include <epoxy/egl.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 480
#define HEIGHT 270

// A body of every shape, in a tank or in a round glass.
static uint8_t *picture_under(ContextKind kind, SimContainerShape container) {
  Harness harness = harness_open(kind, WIDTH, HEIGHT);
  TestFrame *t = test_frame_shapes();
  const SimObstacle more[] = {
      {SIM_SPHERE, {0.4f, 0, 0}, {1.2f, 0.35f, 0.5f}, {0, 0, 0, 1}, {0.8f, 0.7f, 0.3f}, 0, NULL},
      {SIM_CYLINDER, {0.2f, 1, 0}, {1.9f, 0.5f, 0.2f}, {0, 0, 0, 1}, {0.7f, 0.7f, 0.7f}, 0, NULL},
      {SIM_BOX, {0.2f, 0.7f, 0.2f}, {0.3f, 0.5f, 0.8f}, {0, 0, 0, 1}, {0.7f, 0.4f, 0.7f}, 0, NULL}};
  for (int i = 0; i < 3; ++i) t->obstacles[t->frame.obstacle_count++] = more[i];
  t->frame.container.shape = container;
  const RenderView view = harness_view(0.35f, 1.2f, 4.1f, 1.5f, 0.55f, 0.4f, 38);
  const RenderSettings settings = render_default_settings();
  uint8_t *rgb = harness_draw(&harness, &t->frame, &view, &settings);
  test_frame_destroy(t);
  harness_close(&harness);
  return rgb;
}

static void test_egl_and_osmesa_agree(void **state) {
  (void)state;
  char why[256];
  for (int kind = CONTEXT_EGL; kind <= CONTEXT_OSMESA; ++kind) {
    const ContextBackend *backend = context_backend_of_kind((ContextKind)kind);
    assert_non_null(backend);
    if (!backend->available(why, sizeof why)) {
      print_message("%s: %s\n", backend->name, why);
      skip();
    }
  }
  for (int shape = SIM_CONTAINER_BOX; shape <= SIM_CONTAINER_GLASS; ++shape) {
    uint8_t *egl = picture_under(CONTEXT_EGL, (SimContainerShape)shape);
    uint8_t *osmesa = picture_under(CONTEXT_OSMESA, (SimContainerShape)shape);
    int different = 0;
    for (int i = 0; i < WIDTH * HEIGHT; ++i) {
      bool same = true;
      for (int k = 0; k < 3; ++k) same = same && abs(egl[3 * i + k] - osmesa[3 * i + k]) <= 2;
      different += !same;
    }
    if (different * 200 > WIDTH * HEIGHT) {
      fail_msg("%d of %d pixels differ by more than 2/255", different, WIDTH * HEIGHT);
    }
    free(egl);
    free(osmesa);
  }
}

// One after the other, in any order: the pointers that OSMesa needs are put back.
static void test_contexts_follow_each_other(void **state) {
  (void)state;
  char why[256];
  for (int round = 0; round < 2; ++round) {
    for (int i = 0; i < context_backend_count(); ++i) {
      const ContextBackend *backend = context_backend(i);
      if (!backend->available(why, sizeof why)) {
        assert_true(why[0] != '\0' && strchr(why, '\n') == NULL);
        continue;
      }
      Harness harness = harness_open(backend->kind, 16, 16);
      assert_non_null(strstr(render_gl_description(harness.render), " / "));
      harness_close(&harness);
    }
  }
}

static void test_the_table(void **state) {
  (void)state;
  assert_null(context_backend(-1));
  assert_null(context_backend(context_backend_count()));
  assert_null(context_backend_of_kind(CONTEXT_AUTO));
  for (int i = 0; i < context_backend_count(); ++i) {
    assert_ptr_equal(context_backend_of_kind(context_backend(i)->kind), context_backend(i));
    assert_non_null(context_backend(i)->summary);
  }
}

// A driver below 4.5 is turned away in one sentence. Mesa can be told to play one.
static void test_old_opengl_is_refused_in_one_sentence(void **state) {
  (void)state;
  char why[256];
  if (!context_backend_of_kind(CONTEXT_EGL)->available(why, sizeof why)) skip();
  setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
  AppError error = {0};
  Context *context = context_create_headless(CONTEXT_EGL, &error);
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  if (context != NULL) { // not Mesa
    context_destroy(context);
    skip();
  }
  assert_int_equal(error.code, APP_FAILED);
  assert_non_null(strstr(error.message, "4.5"));
}

// The renderer itself turns an older context away as well, whoever made it.
static void test_renderer_needs_4_5(void **state) {
  (void)state;
  setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
  const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 3, EGL_NONE};
  EGLContext context = EGL_NO_CONTEXT;
  if (display != EGL_NO_DISPLAY && eglInitialize(display, NULL, NULL) && eglBindAPI(EGL_OPENGL_API)) {
    context = eglCreateContext(display, NULL, EGL_NO_CONTEXT, wanted);
  }
  unsetenv("MESA_GL_VERSION_OVERRIDE");
  if (context == EGL_NO_CONTEXT || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) skip();
  RenderError error = {0};
  Render *render = render_create(8, 8, &error);
  const bool refused = render == NULL; // a driver that is not Mesa may well give 4.5 here
  render_destroy(render);
  eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);
  eglTerminate(display);
  if (!refused) skip();
  assert_non_null(strstr(error.message, "OpenGL 4.5 is needed"));
  assert_null(strchr(error.message, '\n'));
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_the_table),
      cmocka_unit_test(test_egl_and_osmesa_agree),
      cmocka_unit_test(test_contexts_follow_each_other),
      cmocka_unit_test(test_old_opengl_is_refused_in_one_sentence),
      cmocka_unit_test(test_renderer_needs_4_5),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
