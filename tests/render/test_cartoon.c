// What must hold of the style "cartoon": tones by the formula, water at rest that does not flicker, drops that smear nothing, flat
// walls, and the light that comes from behind and from before the water.
#include "tests/render/drawn.h"
#include "tests/render/walls.h"
#include "tests/render/water.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 160
#define HEIGHT 120
#define PIXELS (WIDTH * HEIGHT)
#define BYTES (3 * PIXELS)
#define RADIUS 0.02f
#define SPACING (2 * RADIUS)
#define DEGREES (180 / 3.14159265358979323846)

static void set3(float to[3], float x, float y, float z) {
  const float v[3] = {x, y, z};
  memcpy(to, v, sizeof v);
}

// Settings that show the water's tones alone.
static RenderSettings bare_settings(void) {
  RenderSettings settings = drawn_settings();
  settings.cartoon.reflection = settings.cartoon.refraction = false;
  settings.cartoon.outline = 0;
  settings.cartoon.half_resolution = false;
  return settings;
}

// ---- Tones -----------------------------------------------------------------------------------------------------------

enum { DARK, MEDIUM, BRIGHT };

// Eqs. 6 and 7 with the print's slips put right; `margin`: how far the cosine's level is from where it changes.
static double level_of(const RenderCartoon *c, double cosine, double sun_y, double *margin) {
  const double l = c->levels, still = l * fmax(sun_y, 0);
  const double x = l * fmax(cosine, 0) + (c->steady ? 0.5 - (still - floor(still)) : 0);
  *margin = fabs(x - round(x));
  return fmin(fmax(c->bright_levels ? ceil(x) : floor(x), c->bright_levels ? 1 : 0), l) / l;
}

static int region_of(const RenderCartoon *c, double level) {
  return level > (double)c->bright_threshold ? BRIGHT : level < (double)c->dark_threshold ? DARK : MEDIUM;
}

static double intensity_of(const RenderCartoon *c, double level) {
  const int region = region_of(c, level);
  return level * (region == BRIGHT ? (double)c->bright_factor : region == DARK ? (double)c->dark_factor : 1);
}

static const float *colour_of(const RenderCartoon *c, int region) {
  return region == DARK ? c->palette.dark : region == MEDIUM ? c->palette.medium : c->palette.bright;
}

// A picture and the layers that tell how it came about.
typedef struct Picture {
  uint8_t *rgb;
  float *tone, *normal, *depth, *cover, *thickness, *background;
} Picture;

static Picture draw(Harness *harness, const SimFrame *frame, const RenderView *view, const RenderSettings *settings) {
  return (Picture){.rgb = harness_draw(harness, frame, view, settings),
                   .tone = harness_layer(harness, "tone", 1, frame, view, settings),
                   .normal = harness_layer(harness, "normal", 3, frame, view, settings),
                   .cover = harness_layer(harness, "cover", 1, frame, view, settings)};
}

// With what the light from behind the water depends on.
static Picture draw_all(Harness *harness, const SimFrame *frame, const RenderView *view,
                        const RenderSettings *settings) {
  Picture p = draw(harness, frame, view, settings);
  p.depth = harness_layer(harness, "depth", 1, frame, view, settings);
  p.thickness = harness_layer(harness, "thickness", 1, frame, view, settings);
  p.background = harness_layer(harness, "background", 3, frame, view, settings);
  return p;
}

static void picture_free(Picture *p) {
  free(p->rgb);
  free(p->tone);
  free(p->normal);
  free(p->depth);
  free(p->cover);
  free(p->thickness);
  free(p->background);
}

// All water, the next pixels included: outlines are mixed with what is behind.
static bool inside(const Picture *p, int i) {
  const int x = i % WIDTH, y = i / WIDTH;
  if (x < 2 || y < 2 || x >= WIDTH - 2 || y >= HEIGHT - 2) return false;
  for (int k = 0; k < 25; ++k) {
    const float tone = p->tone[i + (k / 5 - 2) * WIDTH + k % 5 - 2];
    if (tone < 0.5f || tone > 3.5f || p->cover[i + (k / 5 - 2) * WIDTH + k % 5 - 2] < 0.75f) return false;
  }
  return true;
}

static void unit(const float v[3], double out[3]) {
  double length = 0;
  for (int k = 0; k < 3; ++k) length += (double)v[k] * (double)v[k];
  for (int k = 0; k < 3; ++k) out[k] = (double)v[k] / sqrt(length);
}

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Tones and colours of a body whose normals the layer tells, against the formula. Returns a bit for each region seen.
static int expect_tones(Harness *harness, const SimFrame *frame, const RenderView *view,
                        const RenderSettings *settings) {
  Picture p = draw(harness, frame, view, settings);
  const RenderCartoon *c = &settings->cartoon;
  double sun[3];
  unit(settings->sun_direction, sun);
  int pixels = 0, seen = 0;
  for (int i = 0; i < PIXELS; ++i) {
    double normal[3], margin;
    if (!inside(&p, i)) continue;
    unit(p.normal + 3 * i, normal);
    const double level = level_of(c, dot(normal, sun), sun[1], &margin);
    if (margin < 1e-3) continue; // rounding decides on which side of an edge between tones it is
    const int region = region_of(c, level);
    if (p.tone[i] != (float)(1 + region)) fail_msg("pixel %d: tone %g, not %d", i, (double)p.tone[i], 1 + region);
    for (int k = 0; k < 3; ++k) {
      const double want = 255 * fmin(intensity_of(c, level) * (double)colour_of(c, region)[k], 1);
      if (fabs((double)p.rgb[3 * i + k] - want) > 0.51) {
        fail_msg("pixel %d, channel %d: %d, not %.2f", i, k, p.rgb[3 * i + k], want);
      }
    }
    seen |= 1 << region;
    ++pixels;
  }
  assert_true(pixels > 1000);
  picture_free(&p);
  return seen;
}

static void test_tones(void **state) {
  Harness *harness = *state;
  DrawnWater *ball = drawn_create(RADIUS);
  drawn_add_ball(ball, (const float[3]){0, 0, 0}, 0.25f);
  const RenderView view = harness_view(0.3f, 0.4f, 1.2f, 0, 0, 0, 32);
  RenderSettings settings = bare_settings();
  int seen = 0;
  for (int choice = 0; choice < 20; ++choice) {
    settings.cartoon.half_resolution = choice % 3 != 0;
    settings.cartoon.levels = 2 + choice / 4;
    settings.cartoon.bright_levels = choice & 1;
    settings.cartoon.steady = choice & 2;
    set3(settings.sun_direction, choice % 3 == 0 ? -0.45f : 0.8f, 0.75f, 0.5f - 0.1f * (float)(choice % 5));
    seen |= expect_tones(harness, &ball->frame, &view, &settings);
  }
  assert_int_equal(seen, 7);
  // A sun below the horizon leaves the least light.
  set3(settings.sun_direction, 0, -1, 0);
  expect_tones(harness, &ball->frame, &view, &settings);
  free(ball);
}

// A plane has one normal, known beforehand, and so one tone, whichever way it is tilted against the sun.
static void test_tones_of_a_plane(void **state) {
  Harness *harness = *state;
  DrawnWater *plane = drawn_create(RADIUS);
  drawn_add_block(plane, (const float[3]){0, 0, 0}, 40, 3, 30, 0);
  const RenderView view = harness_view(0.1f, 1.2f, 0.9f, 0, 0, 0, 20);
  RenderSettings settings = bare_settings();
  settings.cartoon.half_resolution = true;
  settings.cartoon.steady = false;
  for (int32_t levels = 2; levels <= 6; ++levels) {
    for (int step = 0; step < 8; ++step) {
      const double angle = (7 + 11 * step) / DEGREES;
      double margin;
      settings.cartoon.levels = levels;
      set3(settings.sun_direction, 0.6f * (float)sin(angle), (float)cos(angle), -0.8f * (float)sin(angle));
      const double level = level_of(&settings.cartoon, cos(angle), cos(angle), &margin);
      if (margin < 0.1) continue; // the plane is not that flat
      float *tone = harness_layer(harness, "tone", 1, &plane->frame, &view, &settings);
      for (int i = 0; i < PIXELS; ++i) {
        // At the picture's border filters see one side only.
        const int x = i % WIDTH, y = i / WIDTH, border = 12;
        if (x < border || y < border || x >= WIDTH - border || y >= HEIGHT - border) continue;
        if (tone[i] != (float)(1 + region_of(&settings.cartoon, level)))
          fail_msg("%d levels, %g degrees: tone %g at %d, %d", (int)levels, angle * DEGREES, (double)tone[i], x, y);
      }
      free(tone);
    }
  }
  free(plane);
}

// ---- What is behind the water, and before it ---------------------------------------------------------------------------

// A texture of half the resolution, mixed from the four texels around a pixel.
static double mixed(const float *half, int x, int y) {
  const int x0 = x % 2 == 0 ? x - 1 : x, y0 = y % 2 == 0 ? y - 1 : y; // the layer repeats each texel
  double sum = 0;
  for (int k = 0; k < 4; ++k) {
    const int u = x0 + k % 2, v = y0 + k / 2;
    const double weight = ((u / 2 == x / 2) ? 0.75 : 0.25) * ((v / 2 == y / 2) ? 0.75 : 0.25);
    sum += weight * (double)half[v * WIDTH + u];
  }
  return sum;
}

// Eqs. 4 and 5.
static double by_angle(const RenderCartoon *c, double cosine, double grazed, double faced) {
  const double low = cos(fmin((double)(c->critical_angle + c->angle_interval), 90) / DEGREES);
  const double high = cos(fmax((double)(c->critical_angle - c->angle_interval), 0) / DEGREES);
  const double t = fmin(fmax((cosine - low) / (high - low), 0), 1);
  return grazed + (faced - grazed) * t * t * (3 - 2 * t);
}

typedef struct Looked {
  int pixels, displaced;
  double worst;       // of 255
  double least, most; // F of Eq. 4 or 5
} Looked;

// Eqs. 3 and 8 to 10 by the layers. The sky has one colour, which is what is mirrored.
static Looked look(Harness *harness, const SimFrame *frame, const RenderView *view, const RenderSettings *settings) {
  Picture p = draw_all(harness, frame, view, settings);
  const RenderCartoon *c = &settings->cartoon;
  const Pinhole pinhole = water_pinhole(view, WIDTH, HEIGHT);
  const double pixel = lens_pixel(&pinhole.lens);
  Looked looked = {.least = 1};
  double sun[3];
  unit(settings->sun_direction, sun);
  for (int i = 0; i < PIXELS; ++i) {
    const int x = i % WIDTH, y = i / WIDTH;
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, x, y);
    const float direction[3] = {(float)ray.direction[0], (float)ray.direction[1], (float)ray.direction[2]};
    double n[3], v[3], in_view[3], margin;
    if (!inside(&p, i)) continue;
    unit(p.normal + 3 * i, n);
    unit(direction, v);
    const double facing = -dot(n, v), metres = mixed(p.thickness, x, y);
    const double level = level_of(c, dot(n, sun), sun[1], &margin);
    pinhole_to_view(&pinhole, n, in_view);
    const double shift = metres * (double)c->bending / ((double)p.depth[i] * pixel);
    const double at_x = fmin(fmax(x + 0.5 + in_view[0] * shift, 0), WIDTH - 1);
    const double at_y = fmin(fmax(HEIGHT - y - 0.5 + in_view[1] * shift, 0), HEIGHT - 1); // from the bottom
    const bool doubtful = margin < 1e-3 || fabs(at_x - round(at_x)) < 1e-3 || fabs(at_y - round(at_y)) < 1e-3;
    if (doubtful) continue;
    const int from = (HEIGHT - 1 - (int)at_y) * WIDTH + (int)at_x;
    const double F_t = by_angle(c, facing, (double)c->least_transparency, (double)c->most_transparency);
    const double F_r = by_angle(c, facing, (double)c->most_reflection, (double)c->least_reflection);
    const double seen = c->refraction ? exp(-metres / (double)c->clearness) * F_t : 0;
    for (int k = 0; k < 3; ++k) {
      const double own = intensity_of(c, level) * (double)colour_of(c, region_of(c, level))[k];
      const double light = own + seen * ((double)p.background[3 * from + k] - own) +
                           (c->reflection ? F_r * (double)settings->sky_zenith[k] : 0);
      looked.worst = fmax(looked.worst, fabs((double)p.rgb[3 * i + k] - 255 * fmin(light, 1)));
    }
    ++looked.pixels;
    looked.displaced += from != i;
    looked.least = fmin(looked.least, c->reflection ? F_r : F_t);
    looked.most = fmax(looked.most, c->reflection ? F_r : F_t);
  }
  picture_free(&p);
  return looked;
}

static RenderSettings clear_settings(void) {
  RenderSettings settings = bare_settings();
  settings.cartoon.clearness = 0.5f;
  settings.cartoon.bending = 0;
  set3(settings.sky_zenith, 0.2f, 0.35f, 0.5f);
  set3(settings.sky_horizon, 0.2f, 0.35f, 0.5f);
  return settings;
}

// A ball has all angles between normal and view.
static void test_light_by_angle(void **state) {
  Harness *harness = *state;
  DrawnWater *ball = drawn_create(RADIUS);
  drawn_add_ball(ball, (const float[3]){0, 0, 0}, 0.25f);
  const RenderView view = harness_view(0.3f, 0.4f, 1.2f, 0, 0, 0, 32);
  for (int choice = 0; choice < 4; ++choice) {
    RenderSettings settings = clear_settings();
    settings.cartoon.reflection = choice == 1 || choice == 3;
    settings.cartoon.refraction = choice == 0 || choice == 3;
    settings.cartoon.most_reflection = 0.5f;
    settings.cartoon.critical_angle =
        40; // two pixels inside its outline the smoothed ball is hardly grazed by 60 degrees
    if (choice == 2)
      settings.cartoon.refraction = true, settings.cartoon.critical_angle = 30, settings.cartoon.angle_interval = 45;
    const Looked looked = look(harness, &ball->frame, &view, &settings);
    print_message("%s%s: %d pixels, factors from %.3f to %.3f, off by %.2f of 255\n",
                  settings.cartoon.refraction ? "from behind " : "", settings.cartoon.reflection ? "from before" : "",
                  looked.pixels, looked.least, looked.most, looked.worst);
    assert_true(looked.pixels > 2000);
    assert_true(looked.most - looked.least > 0.4);
    assert_true(looked.worst < 1);
  }
  free(ball);
}

// A layer of a known thickness, seen at right angles: the sky behind it shines through by e^-T.
static void test_light_through_a_layer(void **state) {
  Harness *harness = *state;
  const RenderView view = harness_view(0, 0, 25, 0, 0, 0, 1.1f);
  for (int layers = 2; layers <= 8; layers += 3) {
    DrawnWater *water = drawn_create(RADIUS);
    drawn_add_block(water, (const float[3]){0, 0, 0}, 40, 30, layers, 0);
    RenderSettings settings = clear_settings();
    settings.cartoon.refraction = true;
    settings.cartoon.most_transparency = 1;
    settings.cartoon.clearness = 0.25f;
    set3(settings.sun_direction, 0, 0, 1);
    set3(settings.sky_zenith, 1, 1, 1);
    set3(settings.sky_horizon, 1, 1, 1);
    for (int k = 0; k < 3; ++k)
      set3(k == 0   ? settings.cartoon.palette.dark
           : k == 1 ? settings.cartoon.palette.medium
                    : settings.cartoon.palette.bright,
           0, 0, 0);
    uint8_t *rgb = harness_draw(harness, &water->frame, &view, &settings);
    const double want = 255 * exp(-(double)layers * (double)SPACING / 0.25);
    for (int y = HEIGHT / 2 - 20; y < HEIGHT / 2 + 20; ++y) {
      for (int x = WIDTH / 2 - 20; x < WIDTH / 2 + 20; ++x) {
        // A lattice's Gaussians add up to its thickness but for 3 %.
        const double slack = want * (exp(0.031 * (double)layers * (double)SPACING / 0.25) - 1) + 0.6;
        if (fabs((double)rgb[3 * (y * WIDTH + x)] - want) > slack)
          fail_msg("%d layers: %d, not %.2f", layers, rgb[3 * (y * WIDTH + x)], want);
      }
    }
    free(rgb);
    free(water);
  }
}

// A flat pool over a checker, seen aslant: the floor is displaced by its metres of water (Eqs. 9, 10).
static void test_displacement(void **state) {
  Harness *harness = *state;
  DrawnWater *pool = drawn_create(RADIUS);
  drawn_add_block(pool, (const float[3]){0, 0.12f, 0}, 34, 5, 26, 0.15f);
  const RenderView view = harness_view(0.25f, 1.3f, 1.2f, 0, 0.1f, 0, 34);
  RenderSettings settings = clear_settings();
  settings.cartoon.refraction = true;
  settings.floor = RENDER_FLOOR_CHECKER;
  settings.floor_level = 0;
  settings.tile_size = 0.07f;
  set3(settings.floor_colour[0], 0.9f, 0.9f, 0.8f);
  set3(settings.floor_colour[1], 0.1f, 0.15f, 0.2f);
  const float bendings[] = {0, 0.3f, -0.5f, 1};
  for (int k = 0; k < 4; ++k) {
    settings.cartoon.bending = bendings[k];
    const Looked looked = look(harness, &pool->frame, &view, &settings);
    print_message("bending %g: %d pixels, %d displaced, off by %.2f of 255\n", (double)bendings[k], looked.pixels,
                  looked.displaced, looked.worst);
    assert_true(looked.pixels > 5000);
    assert_true(k == 0 ? looked.displaced == 0 : looked.displaced > looked.pixels / 2);
    assert_true(looked.worst < 1);
  }
  free(pool);
}

// ---- Stray drops -----------------------------------------------------------------------------------------------------

// Pixels farther than `apart` from all that differ in tone, or have a drop's.
static bool *away_from_drops(const float *tone, double apart) {
  bool *away = malloc(PIXELS);
  const int reach = (int)apart;
  memset(away, 1, PIXELS);
  for (int i = 0; i < PIXELS; ++i) {
    if (tone[i] < 3.5f) continue;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        const int x = i % WIDTH + dx, y = i / WIDTH + dy;
        if (x >= 0 && y >= 0 && x < WIDTH && y < HEIGHT && dx * dx + dy * dy <= apart * apart)
          away[y * WIDTH + x] = false;
      }
    }
  }
  return away;
}

// How many pixels around a drop the drop changes.
static int changed_by_drop(Harness *harness, const DrawnWater *body, const float drop[3],
                           const RenderSettings *settings) {
  const RenderView view = harness_view(0.2f, 0.5f, 1.5f, 0, 0.05f, 0, 30);
  DrawnWater *with = drawn_create(RADIUS);
  const SimFrame own = with->frame;
  memcpy(with, body, sizeof *with);
  with->frame.position = own.position;
  with->frame.particle_class = own.particle_class;
  with->frame.near_surface = own.near_surface;
  drawn_add(with, drop[0], drop[1], drop[2], SIM_SPLASH);
  RenderSettings apart = *settings;
  apart.cartoon.splashes_apart = true;
  float *drop_tone = harness_layer(harness, "tone", 1, &with->frame, &view, &apart);
  uint8_t *before = harness_draw(harness, &body->frame, &view, settings);
  uint8_t *after = harness_draw(harness, &with->frame, &view, settings);
  float *tone_before = harness_layer(harness, "tone", 1, &body->frame, &view, settings);
  float *tone_after = harness_layer(harness, "tone", 1, &with->frame, &view, settings);
  bool *away = away_from_drops(drop_tone, (double)settings->cartoon.outline + 2);
  int changed = 0, drops = 0;
  for (int i = 0; i < PIXELS; ++i) {
    drops += drop_tone[i] > 3.5f;
    changed += away[i] && (memcmp(before + 3 * i, after + 3 * i, 3) != 0 || tone_before[i] != tone_after[i]);
  }
  assert_true(drops >= 4 && drops < PIXELS / 20);
  free(drop_tone);
  free(before);
  free(after);
  free(tone_before);
  free(tone_after);
  free(away);
  free(with);
  return changed;
}

static void test_drops_smear_nothing(void **state) {
  Harness *harness = *state;
  // In front of the body, from touching to far before it; over it; at its silhouette.
  static const float drops[][3] = {{0.05f, 0.05f, 0.27f}, {0.05f, 0.05f, 0.31f}, {0.05f, 0.1f, 0.6f},
                                   {-0.1f, 0.23f, 0},     {0.34f, 0.05f, 0.1f},  {0, 0.45f, 0}};
  DrawnWater *body = drawn_create(RADIUS);
  drawn_add_block(body, (const float[3]){0, 0, 0}, 16, 8, 12, 0.2f);
  int smeared = 0;
  for (int k = 0; k < 6; ++k) {
    for (int choice = k % 2; choice < 6; choice += 2) {
      RenderSettings settings = drawn_settings();
      settings.cartoon.clearness =
          0.3f; // without a container, the scene is as large as what is in it, and by default this too
      settings.cartoon.half_resolution = choice % 2 == 0;
      settings.cartoon.smoothing = choice / 2 == 2 ? RENDER_CARTOON_CURVATURE : RENDER_CARTOON_BILATERAL;
      settings.cartoon.separated = choice / 2 == 1;
      // A drop on the body's silhouette cuts its outline in two, whose last ten pixels are antialiased by themselves.
      if (k == 3 || k == 4) settings.cartoon.outline = 0;
      assert_int_equal(changed_by_drop(harness, body, drops[k], &settings), 0);
      settings.cartoon.splashes_apart = false;
      smeared += changed_by_drop(harness, body, drops[k], &settings) > 0;
    }
  }
  print_message("as in the paper, drops change their surroundings in %d of 18 pictures\n", smeared);
  assert_true(smeared > 9);
  free(body);
}

// ---- Walls -----------------------------------------------------------------------------------------------------------

// The largest error of depth (radii) and normal (degrees) on the walls; `seen`: pixels of them.
static void expect_flat_walls(const char *what, Harness *harness, const TestWater *water, WallMeet *meet,
                              const RenderView *view) {
  RenderSettings settings = bare_settings();
  settings.cartoon.half_resolution = true;
  Picture p = draw_all(harness, &water->frame, view, &settings);
  const double pixel = 2 * tan((double)view->vertical_fov / 2 / DEGREES) / HEIGHT;
  double depth = 0, angle = 0;
  int seen = 0, dry = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    WallMeeting m;
    // The edge to the surface is the particles': there by a radius either way; the others are the wall's by a pixel.
    if (!meet(&ray, 0, &m) || m.from_edge * (double)WALL_RADIUS < fmax(1.5 * pixel * m.depth, 2 * (double)WALL_RADIUS))
      continue;
    ++seen;
    if (p.tone[i] == 0) {
      ++dry;
      continue;
    }
    double squares = 0;
    for (int k = 0; k < 3; ++k) squares += pow((double)p.normal[3 * i + k] - m.normal[k], 2);
    depth = fmax(depth, fabs((double)p.depth[i] - m.depth) / (double)WALL_RADIUS);
    angle = fmax(angle, 2 * asin(fmin(sqrt(squares) / 2, 1)) * DEGREES);
  }
  print_message("%s: %d pixels of walls, %d dry, off by %.2g r, %.2g degrees\n", what, seen, dry, depth, angle);
  assert_true(seen > PIXELS / 20);
  assert_int_equal(dry, 0);
  assert_true(depth < 1e-3);
  assert_true(angle < 0.1);
  picture_free(&p);
}

static bool in_room(const SimContainer *c, const double p[3], double wider) {
  if (p[1] < (double)c->min[1] - wider) return false;
  if (c->shape == SIM_CONTAINER_GLASS) {
    const double r = (double)c->max[0] / 2;
    return hypot(p[0] - r, p[2] - r) < r + wider;
  }
  return p[0] > -wider && p[2] > -wider && p[0] < (double)c->max[0] + wider && p[2] < (double)c->max[2] + wider;
}

// No water where a ray does not come through the container, a pixel's width around it.
static void expect_within_walls(Harness *harness, const TestWater *water, const RenderView *view) {
  RenderSettings settings = bare_settings();
  settings.cartoon.half_resolution = true;
  float *tone = harness_layer(harness, "tone", 1, &water->frame, view, &settings);
  const double pixel = 2 * tan((double)view->vertical_fov / 2 / DEGREES) / HEIGHT;
  int outside = 0, wet = 0;
  for (int i = 0; i < PIXELS; ++i) {
    const Ray ray = harness_ray(view, WIDTH, HEIGHT, i % WIDTH, i / WIDTH);
    bool through = false;
    for (double t = 0.1; t < 6 && !through; t += 0.002) {
      double p[3];
      for (int k = 0; k < 3; ++k) p[k] = ray.origin[k] + t * ray.direction[k];
      through = in_room(&water->frame.container, p, pixel * t);
    }
    outside += !through;
    wet += !through && tone[i] > 0;
  }
  assert_true(outside > PIXELS / 10);
  assert_int_equal(wet, 0);
  free(tone);
}

static void test_walls(void **state) {
  Harness *harness = *state;
  const RenderView level = harness_view(0.5f, 0.25f, 2.4f, 0.52f, 0.22f, 0, 34),
                   above = harness_view(-0.4f, 1.1f, 2.1f, 0.5f, 0.2f, 0.2f, 34);
  const RenderView at_glass = harness_view(0.35f, 0.35f, 2.3f, 0.35f, 0.22f, 0, 30);
  TestWater tank = test_water_pool(&wall_tank, WALL_RADIUS, WALL_LEVEL);
  expect_flat_walls("tank", harness, &tank, wall_meet_tank, &level);
  expect_flat_walls("tank from above", harness, &tank, wall_meet_tank, &above);
  expect_within_walls(harness, &tank, &level);
  expect_within_walls(harness, &tank, &above);
  test_water_destroy(&tank);
  TestWater glass = test_water_pool(&wall_glass, WALL_RADIUS, WALL_LEVEL);
  expect_flat_walls("glass", harness, &glass, wall_meet_glass, &at_glass);
  expect_within_walls(harness, &glass, &at_glass);
  test_water_destroy(&glass);
}

// ---- The same again --------------------------------------------------------------------------------------------------

static void test_same_bytes_again(void **state) {
  Harness *harness = *state;
  TestFrame *t = test_frame_pool();
  TestWater water = test_water_create(t->position, t->frame.count, t->frame.particle_radius, &t->frame.container);
  test_frame_destroy(t);
  const RenderView view = harness_view(1.5f, 1.1f, 3.4f, 1.5f, 0.3f, 0.5f, 38);
  RenderSettings settings = render_default_settings();
  settings.style = "cartoon";
  uint8_t *first = harness_draw(harness, &water.frame, &view, &settings);
  static const char *const between[] = {"cartoon", "points", "refraction", "raycast"};
  for (int k = 0; k < 6; ++k) {
    RenderSettings other = settings;
    other.style = between[k % 4];
    if (k >= 4) other.style = "cartoon";
    if (k == 4) other.cartoon.half_resolution = false;
    if (k == 5) other.cartoon.splashes_apart = false;
    free(harness_draw(harness, &water.frame, &view, &other));
    uint8_t *again = harness_draw(harness, &water.frame, &view, &settings);
    assert_memory_equal(first, again, BYTES);
    free(again);
  }
  free(first);
  test_water_destroy(&water);
}

static int open_harness(void **state) {
  return harness_open_group(state, WIDTH, HEIGHT);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_tones),          cmocka_unit_test(test_tones_of_a_plane),
      cmocka_unit_test(test_light_by_angle), cmocka_unit_test(test_light_through_a_layer),
      cmocka_unit_test(test_displacement),   cmocka_unit_test(test_drops_smear_nothing),
      cmocka_unit_test(test_walls),          cmocka_unit_test(test_same_bytes_again),
  };
  return cmocka_run_group_tests(tests, open_harness, harness_close_group);
}
