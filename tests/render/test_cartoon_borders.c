// What the style "cartoon" makes of water near the borders of it, measured: the filter along rows and columns against the full
// one, and both against a flat pool whose normal is (0, 1, 0) up to its silhouette and up to a ball before it.
#include "tests/render/drawn.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define WIDTH 320
#define HEIGHT 240
#define PIXELS (WIDTH * HEIGHT)
#define RADIUS 0.02f
#define NEAR 15 // pixels from a border: half of the largest kernel
#define DEGREES (180 / 3.14159265358979323846)

// ---- A pool with a ball before it ------------------------------------------------------------------------------------

enum { COLUMNS = 56, ROWS = 44, LAYERS = 3 };
static const float ball_middle[3] = {-0.25f, 0.3f, 0.7f};
#define BALL 0.16f

typedef enum Place { ELSEWHERE = 0, BORDER, AWAY, PLACES } Place;
static const char *const place_names[] = {"", "near borders", "away from them"};

typedef enum Side { ABOVE, BELOW, LEFT, RIGHT, SIDES } Side;

typedef struct Scene {
  Harness harness;
  DrawnWater *water;
  RenderView view;
  Place place[PIXELS]; // of the pool's surface
  Side side[PIXELS];   // BORDER: where the nearest pixel that is not the pool's is
} Scene;

// Does the ray meet the pool's surface, with the outermost particles' middles as its border, and not the ball?
static bool on_pool(const Ray *ray, const float half[2]) {
  double t[2], margin;
  if (harness_ray_sphere(ray, ball_middle, (double)BALL + 1.6 * (double)RADIUS, t, &margin)) return false;
  const double level = (2 * (LAYERS - 1) / 2 + 1.3) * (double)RADIUS; // between the spheres' tops and their notches
  const double depth = (level - ray->origin[1]) / ray->direction[1];
  return depth > 0 && fabs(ray->origin[0] + depth * ray->direction[0]) < (double)half[0] &&
         fabs(ray->origin[2] + depth * ray->direction[2]) < (double)half[1];
}

static void find_places(Scene *s) {
  const float half[2] = {(COLUMNS - 1) * RADIUS, (ROWS - 1) * RADIUS};
  bool *pool = malloc(PIXELS);
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(&s->view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    pool[i] = on_pool(&ray, half);
  }
  for (int i = 0; i < PIXELS; ++i) {
    int nearest = NEAR * NEAR + 1;
    for (int k = 0; pool[i] && k < (2 * NEAR + 1) * (2 * NEAR + 1); ++k) {
      const int dx = k % (2 * NEAR + 1) - NEAR, dy = k / (2 * NEAR + 1) - NEAR, x = i % WIDTH + dx, y = i / WIDTH + dy;
      if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT || dx * dx + dy * dy >= nearest || pool[y * WIDTH + x]) continue;
      nearest = dx * dx + dy * dy;
      s->side[i] = abs(dy) > abs(dx) ? (dy < 0 ? ABOVE : BELOW) : (dx < 0 ? LEFT : RIGHT);
    }
    s->place[i] = !pool[i] ? ELSEWHERE : nearest <= NEAR * NEAR ? BORDER : AWAY;
  }
  free(pool);
}

static int open_scene(void **state) {
  Scene *s = calloc(1, sizeof *s);
  assert_non_null(s);
  s->harness = harness_open(CONTEXT_AUTO, WIDTH, HEIGHT);
  s->water = drawn_create(RADIUS);
  s->view = harness_view(0.3f, 0.75f, 2.6f, -0.02f, 0, 0.1f, 42);
  drawn_add_block(s->water, (const float[3]){0, 0, 0}, COLUMNS, LAYERS, ROWS, 0.1f);
  drawn_add_ball(s->water, ball_middle, BALL);
  find_places(s);
  *state = s;
  return 0;
}

static int close_scene(void **state) {
  Scene *s = *state;
  harness_close(&s->harness);
  free(s->water);
  free(s);
  return 0;
}

// ---- Surfaces and how they differ ------------------------------------------------------------------------------------

typedef struct Surface {
  float *depth, *normal;
} Surface;

static Surface draw(Scene *s, const RenderCartoon *cartoon) {
  RenderSettings settings = drawn_settings();
  settings.cartoon = *cartoon;
  return (Surface){harness_layer(&s->harness, "smooth_depth", 1, &s->water->frame, &s->view, &settings),
                   harness_layer(&s->harness, "smooth_normal", 3, &s->water->frame, &s->view, &settings)};
}

static void surface_free(Surface *surface) {
  free(surface->depth);
  free(surface->normal);
}

typedef struct Spread {
  size_t count;
  double median, share_95, share_99, most;
} Spread;

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static Spread spread_of(double *values, size_t count) {
  assert_true(count > 500);
  qsort(values, count, sizeof *values, ascending);
  return (Spread){count, values[count / 2], values[count * 95 / 100], values[count * 99 / 100], values[count - 1]};
}

static double angle_between(const float a[3], const float b[3]) {
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += pow((double)a[k] - (double)b[k], 2);
  return 2 * asin(fmin(sqrt(squares) / 2, 1)) * DEGREES;
}

// Radii of depth (`angles` false) or degrees between two surfaces in one place; `b` NULL: against (0, 1, 0).
static Spread difference(const Scene *s, Place place, const Surface *a, const Surface *b, bool angles) {
  static const float up[3] = {0, 1, 0};
  double *values = malloc(PIXELS * sizeof *values);
  size_t count = 0;
  for (int i = 0; i < PIXELS; ++i) {
    if (s->place[i] != place || a->depth[i] <= 0 || (b != NULL && b->depth[i] <= 0)) continue;
    values[count++] = angles ? angle_between(a->normal + 3 * i, b != NULL ? b->normal + 3 * i : up)
                             : fabs((double)a->depth[i] - (double)b->depth[i]) / (double)RADIUS;
  }
  const Spread spread = spread_of(values, count);
  free(values);
  return spread;
}

typedef struct Figures {
  Spread depth[PLACES], normal[PLACES];   // of the separated filter against the full one: radii, degrees
  Spread full[PLACES], separated[PLACES]; // of the normals against the truth, degrees
} Figures;

static Figures measure(Scene *s, int32_t kernel, bool fitted) {
  RenderCartoon cartoon = drawn_settings().cartoon;
  cartoon.half_resolution = false;
  cartoon.kernel = kernel;
  cartoon.fitted = fitted;
  cartoon.separated = false;
  Surface full = draw(s, &cartoon);
  cartoon.separated = true;
  Surface separated = draw(s, &cartoon);
  Figures f;
  char name[32];
  snprintf(name, sizeof name, kernel > 0 ? "kernel %d" : "adaptive", (int)kernel);
  for (int place = BORDER; place < PLACES; ++place) {
    f.depth[place] = difference(s, (Place)place, &separated, &full, false);
    f.normal[place] = difference(s, (Place)place, &separated, &full, true);
    f.full[place] = difference(s, (Place)place, &full, NULL, true);
    f.separated[place] = difference(s, (Place)place, &separated, NULL, true);
    const Spread *d = &f.depth[place], *n = &f.normal[place], *u = &f.full[place], *e = &f.separated[place];
    print_message("%-6s %-9s %-14s | %5.2f %5.2f %5.2f | %4.1f %4.1f %4.1f | %4.1f %4.1f | %4.1f %4.1f\n",
                  fitted ? "planes" : "mean", name, place_names[place], d->median, d->share_99, d->most, n->median,
                  n->share_99, n->most, u->median, u->share_95, e->median, e->share_95);
  }
  surface_free(&full);
  surface_free(&separated);
  return f;
}

static void test_separated_filter(void **state) {
  Scene *s = *state;
  static const int32_t kernels[] = {10, 20, 30, 0};
  print_message(
      "separated against full: depth in radii (median, 99 %%, largest), normal in degrees; then normals against "
      "the truth, full and separated (median, 95 %%)\n");
  Figures plain[4], fitted[4];
  for (int k = 0; k < 4; ++k) plain[k] = measure(s, kernels[k], false);
  for (int k = 0; k < 4; ++k) fitted[k] = measure(s, kernels[k], true);
  for (int k = 0; k < 4; ++k) {
    // Planes are separable, but for what bumps do to their weights; means are not, anywhere.
    assert_true(fitted[k].depth[AWAY].most < 0.1 && fitted[k].depth[BORDER].median < 0.03);
    assert_true(plain[k].depth[AWAY].share_99 > 10 * fitted[k].depth[AWAY].share_99);
    if (kernels[k] > 0) assert_true(plain[k].depth[BORDER].median > 5 * fitted[k].depth[BORDER].median);
    // Planes also make the better normals.
    assert_true(fitted[k].full[BORDER].median < 0.6 * plain[k].full[BORDER].median);
    assert_true(fitted[k].full[AWAY].median < 0.6 * plain[k].full[AWAY].median);
  }
  // The default.
  assert_true(fitted[3].normal[AWAY].share_99 < 0.5 && fitted[3].normal[BORDER].median < 0.5);
  assert_true(plain[3].normal[BORDER].median > 5 * fitted[3].normal[BORDER].median);
  assert_true(fitted[3].full[AWAY].share_95 < 2 && fitted[3].full[BORDER].median < 2.5);
}

// ---- Slopes at borders -----------------------------------------------------------------------------------------------

// How far the mean normal, in which bumps cancel, is from the truth: what a filter tilts near each side's borders, degrees.
static void measure_tilt(Scene *s, const char *what, const RenderCartoon *cartoon, double tilt[SIDES]) {
  Surface surface = draw(s, cartoon);
  double sum[SIDES][3] = {{0}};
  for (int i = 0; i < PIXELS; ++i) {
    for (int k = 0; k < 3 && s->place[i] == BORDER; ++k) sum[s->side[i]][k] += (double)surface.normal[3 * i + k];
  }
  for (int side = 0; side < SIDES; ++side)
    tilt[side] = atan2(hypot(sum[side][0], sum[side][2]), sum[side][1]) * DEGREES;
  print_message("%-20s tilted by %5.2f degrees under a border, %5.2f over one, %5.2f right and %5.2f left of one\n",
                what, tilt[ABOVE], tilt[BELOW], tilt[LEFT], tilt[RIGHT]);
  surface_free(&surface);
}

// At silhouettes. Over a border lies the pool's front edge, where the water itself turns down and smoothing rounds it.
static double largest(const double tilt[SIDES]) {
  return fmax(tilt[ABOVE], fmax(tilt[LEFT], tilt[RIGHT]));
}

static void test_slopes_at_borders(void **state) {
  Scene *s = *state;
  RenderCartoon cartoon = drawn_settings().cartoon;
  cartoon.half_resolution = false;
  double fitted[SIDES], plain[SIDES], paper[SIDES], other[SIDES];
  measure_tilt(s, "adaptive, fitted", &cartoon, fitted);
  cartoon.fitted = false;
  measure_tilt(s, "adaptive, plain", &cartoon, plain);
  cartoon.kernel = 20;
  measure_tilt(s, "kernel 20, plain", &cartoon, paper);
  cartoon.separated = true;
  measure_tilt(s, "the same, separated", &cartoon, other);
  cartoon.smoothing = RENDER_CARTOON_CURVATURE;
  measure_tilt(s, "curvature flow", &cartoon, other);
  cartoon.smoothing = RENDER_CARTOON_NONE;
  measure_tilt(s, "none", &cartoon, other);
  assert_true(largest(fitted) < 2);
  assert_true(largest(plain) > 2 * largest(fitted));
  assert_true(largest(paper) > 2 * largest(fitted));
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_separated_filter), cmocka_unit_test(test_slopes_at_borders)};
  return cmocka_run_group_tests(tests, open_scene, close_scene);
}
