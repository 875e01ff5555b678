// How far the renderer's picture of water is from the reference, as a table and as pictures.
//
//   reference_compare SCENE PARTICLES FOLDER [--size WxH] [--style NAME[:REFRACTIONS]] … [--set KEY=VALUE] …
//   reference_compare configs/steps.json run/p_00060.ply out --style points --style refraction:2
//
// The scene gives obstacles (where they stand at the start: moving ones are not moved), camera, tile size and the liquid;
// the particle file, as `lido simulate` writes it, gives the water. The environment is pinned: gradient sky, checker floor,
// no sun, hidden container, no tone curve. Rows of the table: each style that is named, drawn by the renderer; then the
// paper's chain of 1, 2 and 4 refractions on the reference's own surfaces, which is the error that its model has with
// perfect surfaces. Errors are in 1/255, of a pixel the mean of its three channels, over the pixels where the reference
// sees water. Into FOLDER go reference.png and, of each row, its picture and its difference from the reference, times 4.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/context.h"
#include "app/image.h"
#include "app/particle_file.h"
#include "app/scene.h"
#include "tests/reference/reference.h"

enum { MAX_STYLES = 16, MAX_SETS = 64, MAX_PATH = 4096 };

typedef struct Arguments {
  const char *scene, *particles, *folder;
  const char *style[MAX_STYLES], *set[MAX_SETS];
  int style_count, set_count;
  int32_t width, height;
} Arguments;

typedef struct Comparison {
  Arguments arguments;
  Scene scene;
  ParticleFile file;
  SimFrameBuffer *buffer;
  SimFrame frame;
  SimObstacle *obstacles;
  RenderSettings settings;
  RenderView view;
  Context *context;
  Render *render;
  Reference *reference;
  float *light; // of a row
  uint8_t *covered, *expected, *actual, *difference;
  double *error; // of the covered pixels
} Comparison;

// ---- Command line ------------------------------------------------------------------------------------------------------

static bool parse(Arguments *a, int argc, char **argv) {
  const char **place[] = {&a->scene, &a->particles, &a->folder};
  int places = 0;
  *a = (Arguments){.width = 640, .height = 480};
  for (int i = 1; i < argc; ++i) {
    if (strcmp(argv[i], "--size") == 0 && i + 1 < argc) {
      if (sscanf(argv[++i], "%dx%d", &a->width, &a->height) != 2) return false;
    } else if (strcmp(argv[i], "--style") == 0 && i + 1 < argc && a->style_count < MAX_STYLES) {
      a->style[a->style_count++] = argv[++i];
    } else if (strcmp(argv[i], "--set") == 0 && i + 1 < argc && a->set_count < MAX_SETS) {
      a->set[a->set_count++] = argv[++i];
    } else if (argv[i][0] != '-' && places < 3) {
      *place[places++] = argv[i];
    } else {
      return false;
    }
  }
  return places == 3 && a->width > 0 && a->width <= IMAGE_MAX_SIZE && a->height > 0 && a->height <= IMAGE_MAX_SIZE;
}

// ---- The scene ---------------------------------------------------------------------------------------------------------

static bool load_frame(Comparison *c, AppError *error) {
  SimParticleSet set = particle_file_set(&c->file);
  if (set.particle_radius <= 0) set.particle_radius = c->scene.simulation.particle_radius;
  set.colour = NULL; // the reference knows water of one colour
  const unsigned needs = SIM_NEED_ALL & ~(unsigned)SIM_NEED_HEIGHT_FIELD;
  c->buffer = sim_frame_buffer_create();
  SimError reason = {"out of memory"};
  const SimFrame *frame = c->buffer ? sim_frame_from_particles(&set, needs, 0, c->buffer, &reason) : NULL;
  if (!frame) return app_fail(error, APP_FAILED, "%s: %s", c->arguments.particles, reason.message);
  c->frame = *frame;
  return true;
}

static bool load_obstacles(Comparison *c, AppError *error) {
  const SimWorldDef def = scene_world_def(&c->scene);
  c->obstacles = calloc((size_t)def.obstacle_count + 1, sizeof *c->obstacles);
  if (!c->obstacles) return app_fail(error, APP_FAILED, "out of memory");
  for (int32_t i = 0; i < def.obstacle_count; ++i) c->obstacles[i] = def.obstacles[i].body;
  c->frame.obstacles = c->obstacles;
  c->frame.obstacle_count = def.obstacle_count;
  c->frame.container = def.container;
  c->frame.has_container = true;
  return true;
}

static void pin(RenderSettings *settings) {
  settings->sun = settings->shadow = false;
  settings->sky = RENDER_SKY_GRADIENT;
  settings->floor = RENDER_FLOOR_CHECKER;
  settings->container_visible = false;
  settings->tone_map = RENDER_TONE_NONE;
}

static bool load(Comparison *c, AppError *error) {
  if (!scene_load(&c->scene, c->arguments.scene, c->arguments.set, c->arguments.set_count, error)) return false;
  if (!particle_file_read(c->arguments.particles, &c->file, error)) return false;
  if (!load_frame(c, error) || !load_obstacles(c, error)) return false;
  c->settings = scene_render_settings(&c->scene);
  pin(&c->settings);
  c->view = scene_view(&c->scene);
  return true;
}

static bool make_room(Comparison *c, AppError *error) {
  const size_t pixels = (size_t)c->arguments.width * (size_t)c->arguments.height;
  c->light = malloc(3 * pixels * sizeof *c->light);
  c->error = malloc(pixels * sizeof *c->error);
  c->covered = malloc(pixels);
  c->expected = malloc(3 * pixels);
  c->actual = malloc(3 * pixels);
  c->difference = malloc(3 * pixels);
  if (c->light && c->error && c->covered && c->expected && c->actual && c->difference) return true;
  return app_fail(error, APP_FAILED, "out of memory");
}

static bool start_renderer(Comparison *c, AppError *error) {
  if (c->arguments.style_count == 0) return true;
  RenderError cause;
  c->context = context_create_headless(CONTEXT_AUTO, error);
  if (!c->context) return false;
  c->render = render_create(c->arguments.width, c->arguments.height, &cause);
  return c->render ? true : app_fail(error, APP_FAILED, "%s", cause.message);
}

// ---- Rows --------------------------------------------------------------------------------------------------------------

static void to_bytes(const Comparison *c, uint8_t *bytes) {
  const size_t count = 3 * (size_t)c->arguments.width * (size_t)c->arguments.height;
  for (size_t i = 0; i < count; ++i) {
    const float v = 255 * c->light[i] + 0.5f;
    bytes[i] = (uint8_t)(v < 0 ? 0 : v > 255 ? 255 : v);
  }
}

static bool write_png(const Comparison *c, const char *name, const char *what, const uint8_t *rgb, AppError *error) {
  char path[MAX_PATH];
  snprintf(path, sizeof path, "%s/%s%s.png", c->arguments.folder, name, what);
  return image_write_png(path, rgb, c->arguments.width, c->arguments.height, error);
}

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

// The errors of covered pixels in rising order, and the picture of all differences.
static size_t measure(Comparison *c) {
  const size_t pixels = (size_t)c->arguments.width * (size_t)c->arguments.height;
  size_t count = 0;
  for (size_t i = 0; i < pixels; ++i) {
    int sum = 0;
    for (size_t k = 3 * i; k < 3 * i + 3; ++k) {
      const int d = abs(c->actual[k] - c->expected[k]);
      c->difference[k] = (uint8_t)(4 * d > 255 ? 255 : 4 * d);
      sum += d;
    }
    if (c->covered[i]) c->error[count++] = sum / 3.0;
  }
  qsort(c->error, count, sizeof *c->error, by_size);
  return count;
}

static bool tell_row(Comparison *c, const char *name, AppError *error) {
  const size_t count = measure(c);
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += c->error[i];
  const double last = count > 0 ? (double)(count - 1) : 0;
  if (count == 0) c->error[0] = 0;
  printf("%-16s %8.2f %8.2f %8.2f\n", name, sum / (last + 1), c->error[(size_t)(0.5 * last)],
         c->error[(size_t)(0.95 * last)]);
  return write_png(c, name, "", c->actual, error) && write_png(c, name, "_difference", c->difference, error);
}

// `what`: a style, or "refraction:2", of which only two refractions are taken.
static bool draw_row(Comparison *c, const char *what, AppError *error) {
  RenderSettings settings = c->settings;
  RenderError cause;
  char style[32], name[48];
  const size_t length = strcspn(what, ":");
  snprintf(style, sizeof style, "%.*s", (int)length, what);
  snprintf(name, sizeof name, "%s%s%s", style, what[length] ? "_" : "", what[length] ? what + length + 1 : "");
  settings.style = style;
  if (what[length]) settings.refraction.count = atoi(what + length + 1);
  if (!render_draw(c->render, &c->frame, &c->view, &settings, &cause))
    return app_fail(error, APP_FAILED, "%s", cause.message);
  render_read_rgb8(c->render, c->actual);
  return tell_row(c, name, error);
}

static bool chain_row(Comparison *c, int refractions, AppError *error) {
  char name[32];
  snprintf(name, sizeof name, "chain_%d", refractions);
  reference_trace_chain(c->reference, &c->view, c->arguments.width, c->arguments.height, refractions, c->light);
  to_bytes(c, c->actual);
  return tell_row(c, name, error);
}

static double seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static bool trace(Comparison *c, AppError *error) {
  const int32_t width = c->arguments.width, height = c->arguments.height;
  const double begin = seconds();
  c->reference = reference_create(&c->frame, &c->settings);
  if (!c->reference)
    return app_fail(error, APP_FAILED, "the reference cannot be made: out of memory, or spread too far");
  const double made = seconds();
  reference_trace(c->reference, &c->view, width, height, 0, c->light);
  const double traced = seconds();
  to_bytes(c, c->expected);
  reference_cover(c->reference, &c->view, width, height, c->covered);
  const ReferenceMesh mesh = reference_mesh(c->reference);
  size_t covered = 0;
  for (size_t i = 0; i < (size_t)width * (size_t)height; ++i) covered += c->covered[i];
  printf("%d particles, %d triangles, %zu pixels of water\n", (int)c->frame.count, mesh.triangle_count, covered);
  printf("reference: made in %.1f s, traced in %.1f s\n", made - begin, traced - made);
  return write_png(c, "reference", "", c->expected, error);
}

static bool compare(Comparison *c, AppError *error) {
  if (!load(c, error) || !make_room(c, error) || !start_renderer(c, error) || !trace(c, error)) return false;
  printf("%-16s %8s %8s %8s\n", "1/255", "mean", "median", "95 %");
  for (int i = 0; i < c->arguments.style_count; ++i) {
    if (!draw_row(c, c->arguments.style[i], error)) return false;
  }
  const int refractions[] = {1, 2, 4};
  for (int i = 0; i < 3; ++i) {
    if (!chain_row(c, refractions[i], error)) return false;
  }
  return true;
}

static void finish(Comparison *c) {
  reference_destroy(c->reference);
  render_destroy(c->render);
  context_destroy(c->context);
  sim_frame_buffer_destroy(c->buffer);
  particle_file_free(&c->file);
  scene_free(&c->scene);
  free(c->obstacles);
  free(c->light);
  free(c->error);
  free(c->covered);
  free(c->expected);
  free(c->actual);
  free(c->difference);
}

int main(int argc, char **argv) {
  static Comparison comparison;
  AppError error = {APP_OK, ""};
  if (!parse(&comparison.arguments, argc, argv)) {
    fprintf(stderr, "usage: reference_compare SCENE PARTICLES FOLDER [--size WxH] [--style NAME[:REFRACTIONS]] ... "
                    "[--set KEY=VALUE] ...\n");
    return APP_BAD_INPUT;
  }
  const bool good = compare(&comparison, &error);
  finish(&comparison);
  if (good) return APP_OK;
  fprintf(stderr, "reference_compare: %s\n", error.message);
  return error.code;
}
